// SPDX-License-Identifier: MIT
#include "capture/pose/board_refinement.h"

#include "capture/pose/bundle_residuals.h"
#include "capture/pose/joint_pose.h"
#include "core/numerics/median.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace sheen::capture {
namespace {

constexpr double kHuberPx = 1.0;
constexpr int kMinViewsPerTag = 3;  // fewer leave a tag's place to the noise of its corners
constexpr std::size_t kMinViews = 3;

/// A view that poses over the given board, with the detections that carry it.
struct PosedView {
  Parameters camera_from_board;
  std::vector<TagDetection> tags;
};

/// Poses every view and keeps two tags or more of each: a single one says nothing of the layout.
std::vector<PosedView> pose_views(const Board& board, const core::CameraModel& camera,
                                  const std::vector<std::vector<TagDetection>>& views) {
  std::vector<PosedView> posed;
  for (const auto& detections : views) {
    const auto pose = estimate_joint_pose(board, camera, detections);
    if (!pose || pose->tag_ids.size() < 2) continue;
    PosedView view{to_parameters(pose->camera_from_board), {}};
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

/// Joint problem over views, tags and, on request, the lens; residuals are pixels.
class Adjustment {
 public:
  Adjustment(const Board& board, const core::CameraModel& camera, std::vector<PosedView>& views,
             std::map<int, Parameters>& tags) {
    for (PosedView& view : views) {
      for (const TagDetection& tag : view.tags) {
        problem_.AddResidualBlock(tag_residual(camera, tag, board.tags.at(tag.id).size_m),
                                  new ceres::HuberLoss(kHuberPx), view.camera_from_board.data(),
                                  tags[tag.id].data());
      }
    }
  }

  Adjustment(const Board& board, core::LensKind kind, LensParameters& lens,
             std::vector<PosedView>& views,
             std::map<int, Parameters>& tags) {
    for (PosedView& view : views) {
      for (const TagDetection& tag : view.tags) {
        problem_.AddResidualBlock(tag_and_lens_residual(kind, tag, board.tags.at(tag.id).size_m),
                                  new ceres::HuberLoss(kHuberPx), view.camera_from_board.data(),
                                  tags[tag.id].data(), lens.data());
      }
    }
    // The higher terms are free only where the given lens has them.
    std::vector<int> fixed;
    for (std::size_t i = kFirstHighTerm; i < lens.size(); ++i) {
      if (lens[i] == 0) fixed.push_back(static_cast<int>(i));
    }
    if (!fixed.empty()) {
      problem_.SetManifold(lens.data(),
                           new ceres::SubsetManifold(static_cast<int>(lens.size()), fixed));
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
    const auto source = refined.tags.at(id).corners_in_board();
    const auto target = given.tags.at(id).corners_in_board();
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
    shifts_m.push_back((given.tags.at(id).board_from_tag.translation() -
                        refined.tags.at(id).board_from_tag.translation())
                           .norm());
  }
  return core::upper_median(shifts_m);
}

/// Frees all tags but one, which holds the frame while Ceres works.
void free_tags(Adjustment& adjustment, std::map<int, Parameters>& tags) {
  for (auto& [id, tag] : tags) adjustment.hold(tag);
  for (auto tag = std::next(tags.begin()); tag != tags.end(); ++tag) {
    adjustment.release(tag->second);
  }
}

/// Puts the moved tags into the board and lays them on the given ones, so that no single tag
/// decides the frame.
void lay_on_given(const Board& given, const std::map<int, Parameters>& tags, Board& refined) {
  for (const auto& [id, tag] : tags) refined.tags.at(id).board_from_tag = to_isometry(tag);
  const Eigen::Affine3d back = given_from_refined(given, refined, tags);
  const double scale = std::cbrt(back.linear().determinant());
  for (const auto& [id, unused] : tags) {
    auto& tag = refined.tags.at(id);
    tag.board_from_tag.translation() = back * tag.board_from_tag.translation();
    tag.board_from_tag.linear() = back.linear() / scale * tag.board_from_tag.linear();
    tag.size_m *= scale;
  }
}

}  // namespace

std::optional<BoardRefinement> refine_board(const Board& board, const core::CameraModel& camera,
                                            const std::vector<std::vector<TagDetection>>& views,
                                            LensRefinement lens_refinement) {
  // Start from every view's pose over the given board.
  std::vector<PosedView> posed = pose_views(board, camera, views);
  drop_weak_links(posed);
  if (posed.size() < kMinViews) return std::nullopt;
  std::map<int, Parameters> tags;
  for (const auto& view : posed) {
    for (const TagDetection& tag : view.tags) {
      tags[tag.id] = to_parameters(board.tags.at(tag.id).board_from_tag);
    }
  }
  Adjustment adjustment(board, camera, posed, tags);

  // Measure the given board at its best poses.
  for (auto& [id, tag] : tags) adjustment.hold(tag);
  adjustment.solve();
  BoardRefinement result;
  result.board = board;
  result.camera = camera;
  result.views = static_cast<int>(posed.size());
  result.tags = static_cast<int>(tags.size());
  result.rms_before_px = adjustment.rms_px();

  // Free the tags, then the lens.
  free_tags(adjustment, tags);
  adjustment.solve();
  result.rms_after_px = adjustment.rms_px();
  if (lens_refinement == LensRefinement::on) {
    LensParameters lens = lens_parameters(camera);
    Adjustment with_lens(board, camera.intrinsics().lens, lens, posed, tags);
    free_tags(with_lens, tags);
    with_lens.solve();
    result.rms_after_px = with_lens.rms_px();
    result.camera = camera_with(lens, camera);
  }
  lay_on_given(board, tags, result.board);
  result.median_shift_m = median_shift_m(board, result.board, tags);
  return result;
}

}  // namespace sheen::capture
