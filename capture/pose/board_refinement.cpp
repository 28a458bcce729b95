// SPDX-License-Identifier: MIT
#include "capture/pose/board_refinement.h"

#include "capture/pose/joint_pose.h"
#include "core/alignment/projection_derivative.h"
#include "core/numerics/median.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace sheen::capture {
namespace {

constexpr double kHuberPx = 1.0;
constexpr int kMinViewsPerTag = 3;  // fewer leave a tag's place to the noise of its corners
constexpr std::size_t kMinViews = 3;

/// A rigid transform as Ceres moves it: rotation vector, translation.
using Parameters = std::array<double, 6>;

Parameters to_parameters(const Eigen::Isometry3d& transform) {
  const Eigen::AngleAxisd rotation(transform.linear());
  const Eigen::Vector3d r = rotation.angle() * rotation.axis();
  const Eigen::Vector3d t = transform.translation();
  return {r.x(), r.y(), r.z(), t.x(), t.y(), t.z()};
}

Eigen::Isometry3d to_isometry(const Parameters& p) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d r(p[0], p[1], p[2]);
  if (r.norm() > 0) {
    transform.linear() = Eigen::AngleAxisd(r.norm(), r.normalized()).toRotationMatrix();
  }
  transform.translation() = Eigen::Vector3d(p[3], p[4], p[5]);
  return transform;
}

/// Distance of the four corners of one tag in one view from where the layout puts them.
class TagResidual {
 public:
  TagResidual(const core::CameraModel& camera, const TagDetection& seen, double size_m)
      : camera_(camera), seen_(seen), half_m_(size_m / 2) {}

  template <typename T>
  bool operator()(const T* camera_from_stage, const T* stage_from_tag, T* residuals) const {
    constexpr std::array<std::array<int, 2>, 4> signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (std::size_t c = 0; c < 4; ++c) {
      const T in_tag[3] = {T(signs[c][0] * half_m_), T(signs[c][1] * half_m_), T(0)};
      T in_stage[3];
      transform(stage_from_tag, in_tag, in_stage);
      T in_camera[3];
      transform(camera_from_stage, in_stage, in_camera);
      if (!project(in_camera, residuals + 2 * c)) return false;
      residuals[2 * c] -= seen_.corners_px[c].x();
      residuals[2 * c + 1] -= seen_.corners_px[c].y();
    }
    return true;
  }

 private:
  template <typename T>
  static void transform(const T* target_from_source, const T* point, T* result) {
    ceres::AngleAxisRotatePoint(target_from_source, point, result);
    for (int i = 0; i < 3; ++i) result[i] += target_from_source[3 + i];
  }

  bool project(const double* point, double* pixel) const {
    const auto projected = camera_.project({point[0], point[1], point[2]});
    if (!projected) return false;
    pixel[0] = projected->x();
    pixel[1] = projected->y();
    return true;
  }

  /// The lens by its own derivative, chained to what the point depends on.
  template <typename T, int N>
  bool project(const ceres::Jet<T, N>* point, ceres::Jet<T, N>* pixel) const {
    const auto projected =
        core::project_with_derivative(camera_, {point[0].a, point[1].a, point[2].a});
    if (!projected) return false;
    for (int i = 0; i < 2; ++i) {
      pixel[i].a = projected->pixel[i];
      pixel[i].v = projected->pixel_by_point(i, 0) * point[0].v +
                   projected->pixel_by_point(i, 1) * point[1].v +
                   projected->pixel_by_point(i, 2) * point[2].v;
    }
    return true;
  }

  const core::CameraModel& camera_;
  const TagDetection& seen_;
  double half_m_;
};

/// A view that poses over the given board, with the detections that carry it.
struct PosedView {
  Parameters camera_from_stage;
  std::vector<TagDetection> tags;
};

/// Poses every view and keeps two tags or more of each: a single one says nothing of the layout.
std::vector<PosedView> pose_views(const Board& board, const core::CameraModel& camera,
                                  const std::vector<std::vector<TagDetection>>& views) {
  std::vector<PosedView> posed;
  for (const auto& detections : views) {
    const auto pose = estimate_joint_pose(board, camera, detections);
    if (!pose || pose->tag_ids.size() < 2) continue;
    PosedView view{to_parameters(pose->camera_from_stage), {}};
    for (const TagDetection& tag : detections) {
      if (board.tags.contains(tag.id)) view.tags.push_back(tag);
    }
    posed.push_back(std::move(view));
  }
  return posed;
}

/// Drops tags seen too rarely, then views left with fewer than two, until nothing changes.
void drop_weak_links(std::vector<PosedView>& views) {
  bool has_changed = true;
  while (has_changed) {
    std::map<int, int> counts;
    for (const auto& view : views) {
      for (const TagDetection& tag : view.tags) ++counts[tag.id];
    }
    has_changed = false;
    for (auto& view : views) {
      has_changed |= std::erase_if(view.tags, [&](const TagDetection& tag) {
                       return counts[tag.id] < kMinViewsPerTag;
                     }) > 0;
    }
    has_changed |=
        std::erase_if(views, [](const PosedView& view) { return view.tags.size() < 2; }) > 0;
  }
}

/// Joint problem over views and tags; residuals are pixels.
class Adjustment {
 public:
  Adjustment(const Board& board, const core::CameraModel& camera, std::vector<PosedView>& views,
             std::map<int, Parameters>& tags) {
    for (PosedView& view : views) {
      for (const TagDetection& tag : view.tags) {
        problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<TagResidual, 8, 6, 6>(
                                      new TagResidual(camera, tag, board.tags.at(tag.id).size_m)),
                                  new ceres::HuberLoss(kHuberPx), view.camera_from_stage.data(),
                                  tags[tag.id].data());
      }
    }
  }

  void hold(Parameters& block) { problem_.SetParameterBlockConstant(block.data()); }
  void release(Parameters& block) { problem_.SetParameterBlockVariable(block.data()); }

  void solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_SCHUR;
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-14;
    options.parameter_tolerance = 1e-12;
    options.gradient_tolerance = 1e-14;
    options.num_threads = 1;  // sums in one order: the same board on every machine
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
  }

  /// Root mean square over corners.
  [[nodiscard]] double rms_px() {
    ceres::Problem::EvaluateOptions options;
    options.apply_loss_function = false;
    double half_square_sum = 0;
    problem_.Evaluate(options, &half_square_sum, nullptr, nullptr, nullptr);
    const int corners = problem_.NumResiduals() / 2;
    return std::sqrt(2 * half_square_sum / std::max(1, corners));
  }

 private:
  ceres::Problem problem_;
};

/// Similarity that lays the refined tags' corners on the given ones. The scale is taken from where
/// the tags lie, not from their size: ink and lens blur shift every edge of a square by the same
/// fraction of a pixel, which made the layout of the sample session 0.5 % too large (2.2 mm in the
/// camera's distance) when size alone decided.
Eigen::Affine3d given_from_refined(const Board& given, const Board& refined,
                                   const std::map<int, Parameters>& moved) {
  Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(4 * moved.size()));
  Eigen::Matrix3Xd to(3, from.cols());
  Eigen::Index column = 0;
  for (const auto& [id, unused] : moved) {
    const auto source = refined.tags.at(id).corners_in_stage();
    const auto target = given.tags.at(id).corners_in_stage();
    for (std::size_t c = 0; c < 4; ++c, ++column) {
      from.col(column) = source[c];
      to.col(column) = target[c];
    }
  }
  return Eigen::Affine3d(Eigen::umeyama(from, to, true));
}

double median_shift_m(const Board& given, const Board& refined,
                      const std::map<int, Parameters>& moved) {
  std::vector<double> shifts_m;
  for (const auto& [id, unused] : moved) {
    shifts_m.push_back((given.tags.at(id).stage_from_tag.translation() -
                        refined.tags.at(id).stage_from_tag.translation())
                           .norm());
  }
  return core::upper_median(shifts_m);
}

}  // namespace

std::optional<BoardRefinement> refine_board(const Board& board, const core::CameraModel& camera,
                                            const std::vector<std::vector<TagDetection>>& views) {
  // Start from every view's pose over the given board.
  std::vector<PosedView> posed = pose_views(board, camera, views);
  drop_weak_links(posed);
  if (posed.size() < kMinViews) return std::nullopt;
  std::map<int, Parameters> tags;
  for (const auto& view : posed) {
    for (const TagDetection& tag : view.tags) {
      tags[tag.id] = to_parameters(board.tags.at(tag.id).stage_from_tag);
    }
  }
  Adjustment adjustment(board, camera, posed, tags);

  // Measure the given board at its best poses.
  for (auto& [id, tag] : tags) adjustment.hold(tag);
  adjustment.solve();
  BoardRefinement result{board, static_cast<int>(posed.size()), static_cast<int>(tags.size()), 0, 0,
                         0};
  result.rms_before_px = adjustment.rms_px();

  // Free all tags but one, which holds the frame while Ceres works.
  for (auto tag = std::next(tags.begin()); tag != tags.end(); ++tag) {
    adjustment.release(tag->second);
  }
  adjustment.solve();
  result.rms_after_px = adjustment.rms_px();

  // Lay the result on the given board, so that no single tag decides the frame.
  for (const auto& [id, tag] : tags) result.board.tags.at(id).stage_from_tag = to_isometry(tag);
  const Eigen::Affine3d back = given_from_refined(board, result.board, tags);
  const double scale = std::cbrt(back.linear().determinant());
  for (const auto& [id, unused] : tags) {
    auto& tag = result.board.tags.at(id);
    tag.stage_from_tag.translation() = back * tag.stage_from_tag.translation();
    tag.stage_from_tag.linear() = back.linear() / scale * tag.stage_from_tag.linear();
    tag.size_m *= scale;
  }
  result.median_shift_m = median_shift_m(board, result.board, tags);
  return result;
}

}  // namespace sheen::capture
