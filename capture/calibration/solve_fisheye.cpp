// SPDX-License-Identifier: MIT
#include "capture/calibration/lens_solution.h"
#include "capture/pose/bundle_residuals.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/covariance.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/rotation.h>
#include <ceres/solver.h>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace sheen::capture {
namespace {

constexpr std::array kFieldsOfView_deg{90.0, 120.0, 150.0, 180.0};  // along the longer side
constexpr double kSteepest = 4;  // tan of 76 degrees: points beyond it begin no pose
constexpr std::size_t kFewestPoints = 4;
constexpr int kFirstTerm = 4, kMostTerms = 4, kFewestTerms = 2;  // in LensParameters
constexpr double kSureTerm = 3;                                  // standard deviations

/// Distance of a point of the target from where it is seen, px: of the pose and the lens.
struct PointResidual {
  Eigen::Vector3d on_target;
  Eigen::Vector2d in_image;

  template <typename T>
  bool operator()(const T* camera_from_target, const T* lens, T* residuals) const {
    const T point[3] = {T(on_target.x()), T(on_target.y()), T(on_target.z())};
    T p[3];
    ceres::AngleAxisRotatePoint(camera_from_target, point, p);
    for (int i = 0; i < 3; ++i) p[i] += camera_from_target[3 + i];
    if (!(p[2] > T(0))) return false;
    T u, v;
    core::distort(core::LensKind::fisheye, lens + kFirstTerm, T(p[0] / p[2]), T(p[1] / p[2]), u, v);
    residuals[0] = lens[0] * u + lens[2] - in_image.x();
    residuals[1] = lens[1] * v + lens[3] - in_image.y();
    return true;
  }
};

core::CameraModel fisheye_of(const ImageSize& size, double field_of_view_deg) {
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = size.width_px;
  intrinsics.height_px = size.height_px;
  const double side = std::max(size.width_px, size.height_px);
  intrinsics.focal_px.setConstant(side / (field_of_view_deg * std::numbers::pi / 180));
  intrinsics.principal_px = {(size.width_px - 1) / 2.0, (size.height_px - 1) / 2.0};
  intrinsics.lens = core::LensKind::fisheye;
  return core::CameraModel(intrinsics);
}

/// Pose of the target under a lens that is about right.
std::optional<Eigen::Isometry3d> first_pose(const TargetView& view,
                                            const core::CameraModel& camera) {
  std::vector<cv::Point3d> on_target;
  std::vector<cv::Point2d> ideal;
  for (std::size_t i = 0; i < view.on_target.size(); ++i) {
    const auto ray = camera.unproject(view.in_image[i]);
    if (!ray || ray->head<2>().norm() > kSteepest) continue;
    const Eigen::Vector3d& p = view.on_target[i];
    on_target.emplace_back(p.x(), p.y(), p.z());
    ideal.emplace_back(ray->x(), ray->y());
  }
  if (on_target.size() < kFewestPoints) return std::nullopt;
  cv::Mat rotation, translation;
  try {
    if (!cv::solvePnP(on_target, ideal, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotation,
                      translation)) {
      return std::nullopt;
    }
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  const Parameters parameters{rotation.at<double>(0),    rotation.at<double>(1),
                              rotation.at<double>(2),    translation.at<double>(0),
                              translation.at<double>(1), translation.at<double>(2)};
  if (!(parameters[5] > 0)) return std::nullopt;
  return to_isometry(parameters);
}

bool is_in_front(const TargetView& view, const Eigen::Isometry3d& camera_from_target) {
  return std::all_of(
      view.on_target.begin(), view.on_target.end(),
      [&](const Eigen::Vector3d& point) { return (camera_from_target * point).z() > 0; });
}

/// All poses and the lens.
struct FisheyeBundle {
  const std::vector<TargetView>& views;
  std::vector<Parameters> poses;
  LensParameters lens{};
  double cost = std::numeric_limits<double>::infinity();
  LensParameters sigmas{};  ///< of the lens, where they were asked for

  /// Solves for the poses, the lens and its first `terms` terms; false where that fails.
  bool solve(int terms, bool with_sigmas) {
    ceres::Problem problem;
    for (std::size_t v = 0; v < views.size(); ++v) {
      for (std::size_t i = 0; i < views[v].on_target.size(); ++i) {
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<PointResidual, 2, 6, 12>(
                new PointResidual{views[v].on_target[i], views[v].in_image[i]}),
            nullptr, poses[v].data(), lens.data());
      }
    }
    std::vector<int> held;
    for (int i = kFirstTerm + terms; i < static_cast<int>(lens.size()); ++i) {
      lens[static_cast<std::size_t>(i)] = 0;
      held.push_back(i);
    }
    problem.SetManifold(lens.data(), new ceres::SubsetManifold(12, held));
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.max_num_iterations = 100;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;  // sums in one order
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    cost = summary.final_cost;
    if (!summary.IsSolutionUsable() || !std::isfinite(cost)) return false;
    return !with_sigmas || measure_sigmas(problem);
  }

 private:
  bool measure_sigmas(ceres::Problem& problem) {
    ceres::Covariance::Options options;
    options.num_threads = 1;
    ceres::Covariance covariance(options);
    const std::pair<const double*, const double*> block(lens.data(), lens.data());
    std::array<double, 144> values{};
    if (!covariance.Compute({block}, &problem) ||
        !covariance.GetCovarianceBlock(lens.data(), lens.data(), values.data())) {
      return false;
    }
    // The residuals say how large the noise is.
    const double unknowns = 6.0 * static_cast<double>(views.size()) + kFirstTerm + kMostTerms;
    const double freedoms = problem.NumResiduals() - unknowns;
    const double variance = 2 * cost / std::max(1.0, freedoms);
    for (std::size_t i = 0; i < lens.size(); ++i) {
      sigmas[i] = std::sqrt(variance * values[13 * i]);
    }
    return true;
  }
};

std::optional<FisheyeBundle> begin_with(const std::vector<TargetView>& views,
                                        const core::CameraModel& camera) {
  FisheyeBundle bundle{views, {}, lens_parameters(camera)};
  for (const TargetView& view : views) {
    const auto pose = first_pose(view, camera);
    // What begins behind the camera has no residual, and Ceres would complain on stderr.
    if (!pose || !is_in_front(view, *pose)) return std::nullopt;
    bundle.poses.push_back(to_parameters(*pose));
  }
  if (!bundle.solve(0, false)) return std::nullopt;
  return bundle;
}

}  // namespace

std::optional<LensSolution> solve_fisheye(const std::vector<TargetView>& views,
                                          const ImageSize& size) {
  std::optional<FisheyeBundle> best;
  core::CameraModel begin;
  for (const double field_deg : kFieldsOfView_deg) {
    const core::CameraModel camera = fisheye_of(size, field_deg);
    auto bundle = begin_with(views, camera);
    if (!bundle || (best && bundle->cost >= best->cost)) continue;
    best.emplace(std::move(*bundle));
    begin = camera;
  }
  if (!best) return std::nullopt;
  // A term that is not sure bends the image at will where no point was seen.
  for (int terms = kMostTerms;; --terms) {
    if (!best->solve(terms, true)) return std::nullopt;
    const auto last = static_cast<std::size_t>(kFirstTerm + terms - 1);
    if (terms == kFewestTerms || std::abs(best->lens[last]) > kSureTerm * best->sigmas[last]) break;
  }
  LensSolution solution;
  solution.camera = camera_with(best->lens, begin);
  solution.focal_sigma_px = {best->sigmas[0], best->sigmas[1]};
  solution.principal_sigma_px = {best->sigmas[2], best->sigmas[3]};
  for (const Parameters& pose : best->poses) {
    solution.camera_from_target.push_back(to_isometry(pose));
  }
  return solution;
}

}  // namespace sheen::capture
