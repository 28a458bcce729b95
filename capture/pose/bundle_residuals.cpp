// SPDX-License-Identifier: MIT
#include "capture/pose/bundle_residuals.h"

#include "core/alignment/projection_derivative.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>

#include <algorithm>

namespace sheen::capture {
namespace {

template <typename T>
void transform(const T* target_from_source, const T* point, T* result) {
  ceres::AngleAxisRotatePoint(target_from_source, point, result);
  for (int i = 0; i < 3; ++i) result[i] += target_from_source[3 + i];
}

/// Calls `use(corner, point in the camera frame)` for the four corners of a tag; false when one of
/// the calls says so.
template <typename T, typename Use>
bool for_each_corner(double half_m, const T* camera_from_board, const T* board_from_tag,
                     const Use& use) {
  constexpr std::array<std::array<int, 2>, 4> signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t c = 0; c < 4; ++c) {
    const T in_tag[3] = {T(signs[c][0] * half_m), T(signs[c][1] * half_m), T(0)};
    T in_board[3];
    transform(board_from_tag, in_tag, in_board);
    T in_camera[3];
    transform(camera_from_board, in_board, in_camera);
    if (!use(c, in_camera)) return false;
  }
  return true;
}

class TagResidual {
 public:
  TagResidual(const core::CameraModel& camera, const TagDetection& seen, double size_m)
      : camera_(camera), seen_(seen), half_m_(size_m / 2) {}

  template <typename T>
  bool operator()(const T* camera_from_board, const T* board_from_tag, T* residuals) const {
    return for_each_corner(half_m_, camera_from_board, board_from_tag,
                           [&](std::size_t c, const T* in_camera) {
                             if (!project(in_camera, residuals + 2 * c)) return false;
                             residuals[2 * c] -= seen_.corners_px[c].x();
                             residuals[2 * c + 1] -= seen_.corners_px[c].y();
                             return true;
                           });
  }

 private:
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

class TagAndLensResidual {
 public:
  TagAndLensResidual(core::LensKind kind, const TagDetection& seen, double size_m)
      : kind_(kind), seen_(seen), half_m_(size_m / 2) {}

  template <typename T>
  bool operator()(const T* camera_from_board, const T* board_from_tag, const T* lens,
                  T* residuals) const {
    return for_each_corner(half_m_, camera_from_board, board_from_tag,
                           [&](std::size_t c, const T* in_camera) {
                             if (!(in_camera[2] > T(0))) return false;
                             project(lens, in_camera, residuals + 2 * c);
                             residuals[2 * c] -= seen_.corners_px[c].x();
                             residuals[2 * c + 1] -= seen_.corners_px[c].y();
                             return true;
                           });
  }

 private:
  /// core::CameraModel::project, of the lens too.
  template <typename T>
  void project(const T* lens, const T* point, T* pixel) const {
    T u;
    T v;
    core::distort(kind_, lens + 4, T(point[0] / point[2]), T(point[1] / point[2]), u, v);
    pixel[0] = lens[0] * u + lens[2];
    pixel[1] = lens[1] * v + lens[3];
  }

  core::LensKind kind_;
  const TagDetection& seen_;
  double half_m_;
};

}  // namespace

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

LensParameters lens_parameters(const core::CameraModel& camera) {
  const auto& intrinsics = camera.intrinsics();
  LensParameters lens{intrinsics.focal_px.x(), intrinsics.focal_px.y(), intrinsics.principal_px.x(),
                      intrinsics.principal_px.y()};
  std::copy(intrinsics.distortion.begin(), intrinsics.distortion.end(), lens.begin() + 4);
  return lens;
}

core::CameraModel camera_with(const LensParameters& lens, const core::CameraModel& camera) {
  core::CameraModel::Intrinsics intrinsics = camera.intrinsics();
  intrinsics.focal_px = {lens[0], lens[1]};
  intrinsics.principal_px = {lens[2], lens[3]};
  std::copy(lens.begin() + 4, lens.end(), intrinsics.distortion.begin());
  return core::CameraModel(intrinsics);
}

ceres::CostFunction* tag_residual(const core::CameraModel& camera, const TagDetection& seen,
                                  double size_m) {
  return new ceres::AutoDiffCostFunction<TagResidual, 8, 6, 6>(
      new TagResidual(camera, seen, size_m));
}

ceres::CostFunction* tag_and_lens_residual(core::LensKind kind, const TagDetection& seen,
                                           double size_m) {
  return new ceres::AutoDiffCostFunction<TagAndLensResidual, 8, 6, 6, 12>(
      new TagAndLensResidual(kind, seen, size_m));
}

}  // namespace sheen::capture
