// SPDX-License-Identifier: MIT
#include "capture/calibration/calibrate_camera.h"

#include "capture/calibration/lens_solution.h"
#include "core/numerics/median.h"

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace sheen::capture {
namespace {

constexpr std::size_t kMinViews = 3;
constexpr double kSurelyNotZero = 3;   // standard deviations
constexpr double kFarAbove = 3;        // of the median error, for views that are dropped
constexpr double kAlwaysFinePx = 0.5;  // views this good stay whatever the others do
constexpr double kBetter = 0.9, kSurelyBetter = 0.5;  // shares of the other lens' median error
constexpr double kAsGood = 1.05;
constexpr double kLeftOut_px = 1e4;
constexpr double kNarrow_rad = 90 * std::numbers::pi / 180;  // fields of view that no fisheye has
// What is kept of a solution's digits. Beyond them they depend on where the solver's memory lies
// (LAPACK sums by its alignment; 4e-10 px seen), so that two runs would write other files.
constexpr double kPixelStep = 1e-5;
constexpr double kDistortionStep = 1e-6;

/// A view as a point of the space in which views should be spread: where the target is, how large,
/// how it tapers.
using Signature = std::array<double, 5>;

Signature signature_of(const TargetView& view, const ImageSize& size) {
  // Bring the target to unit size, so that the homography's last row measures the taper.
  std::vector<cv::Point2d> from;
  std::vector<cv::Point2d> to;
  Eigen::AlignedBox2d target;
  Eigen::AlignedBox2d image;
  for (std::size_t i = 0; i < view.on_target.size(); ++i) {
    target.extend(view.on_target[i].head<2>());
    image.extend(view.in_image[i]);
  }
  const double unit = std::max(target.sizes().maxCoeff(), 1e-9);
  for (std::size_t i = 0; i < view.on_target.size(); ++i) {
    const Eigen::Vector2d p = (view.on_target[i].head<2>() - target.center()) / unit;
    from.emplace_back(p.x(), p.y());
    to.emplace_back(view.in_image[i].x(), view.in_image[i].y());
  }
  const cv::Mat H = cv::findHomography(from, to);
  const double side = std::max(size.width_px, size.height_px);
  Signature signature{image.center().x() / side, image.center().y() / side,
                      image.sizes().norm() / (2 * side), 0, 0};
  if (!H.empty() && H.at<double>(2, 2) != 0) {
    signature[3] = std::clamp(2 * H.at<double>(2, 0) / H.at<double>(2, 2), -2.0, 2.0);
    signature[4] = std::clamp(2 * H.at<double>(2, 1) / H.at<double>(2, 2), -2.0, 2.0);
  }
  return signature;
}

double squared_distance(const Signature& a, const Signature& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

/// The views as OpenCV wants them.
struct Points {
  std::vector<std::vector<cv::Point3f>> target;
  std::vector<std::vector<cv::Point2f>> image;
  std::vector<std::vector<cv::Point3f>> flat_target;  // for the first guess

  explicit Points(const std::vector<TargetView>& views) {
    for (const TargetView& view : views) {
      auto& target_points = target.emplace_back();
      auto& flat_points = flat_target.emplace_back();
      auto& image_points = image.emplace_back();
      for (std::size_t i = 0; i < view.on_target.size(); ++i) {
        const Eigen::Vector3f p = view.on_target[i].cast<float>();
        const Eigen::Vector2f q = view.in_image[i].cast<float>();
        target_points.emplace_back(p.x(), p.y(), p.z());
        flat_points.emplace_back(p.x(), p.y(), 0.0F);
        image_points.emplace_back(q.x(), q.y());
      }
    }
  }
};

struct Solution {
  cv::Mat K;
  cv::Mat distortion;
  cv::Mat sigmas;  ///< fx fy cx cy k1 k2 p1 p2 k3 ...
  std::vector<cv::Mat> rotations, translations;
};

std::optional<Solution> solve(const Points& points, const ImageSize& size, int flags) {
  const cv::Size image_size(size.width_px, size.height_px);
  Solution solution;
  try {
    solution.K = cv::initCameraMatrix2D(points.flat_target, points.image, image_size);
    // A poor first guess (parallel views) may lie anywhere; begin with something that can be.
    const double side = std::max(size.width_px, size.height_px);
    for (int i = 0; i < 2; ++i) {
      double& focal = solution.K.at<double>(i, i);
      focal = std::isfinite(focal) ? std::clamp(focal, 0.3 * side, 10 * side) : 1.1 * side;
    }
    solution.distortion = cv::Mat::zeros(1, 5, CV_64F);
    cv::Mat extrinsic_sigmas;
    cv::Mat view_errors;
    const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-12);
    cv::calibrateCamera(points.target, points.image, image_size, solution.K, solution.distortion,
                        solution.rotations, solution.translations, solution.sigmas,
                        extrinsic_sigmas, view_errors, flags | cv::CALIB_USE_INTRINSIC_GUESS, stop);
  } catch (const cv::Exception&) {
    return std::nullopt;  // degenerate views
  }
  if (!cv::checkRange(solution.K) || !cv::checkRange(solution.distortion)) return std::nullopt;
  return solution;
}

core::CameraModel to_camera(const Solution& solution, const ImageSize& size) {
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = size.width_px;
  intrinsics.height_px = size.height_px;
  intrinsics.focal_px = {solution.K.at<double>(0, 0), solution.K.at<double>(1, 1)};
  intrinsics.principal_px = {solution.K.at<double>(0, 2), solution.K.at<double>(1, 2)};
  for (int i = 0; i < 5; ++i) {
    intrinsics.distortion[static_cast<std::size_t>(i)] = solution.distortion.at<double>(i);
  }
  return core::CameraModel(intrinsics);
}

Eigen::Isometry3d pose_of(const cv::Mat& rotation, const cv::Mat& translation) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  cv::Matx33d R;
  cv::Rodrigues(rotation, R);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) transform.linear()(row, column) = R(row, column);
    transform.translation()[row] = translation.at<double>(row);
  }
  return transform;
}

std::optional<LensSolution> solve_rational(const std::vector<TargetView>& views,
                                           const ImageSize& size) {
  const Points points(views);
  auto found = solve(points, size, 0);
  // k3 bends the corners of the image at will where no point was seen: only what is sure counts.
  if (!found ||
      std::abs(found->distortion.at<double>(4)) < kSurelyNotZero * found->sigmas.at<double>(8)) {
    found = solve(points, size, cv::CALIB_FIX_K3);
  }
  if (!found) return std::nullopt;
  LensSolution solution;
  solution.camera = to_camera(*found, size);
  solution.focal_sigma_px = {found->sigmas.at<double>(0), found->sigmas.at<double>(1)};
  solution.principal_sigma_px = {found->sigmas.at<double>(2), found->sigmas.at<double>(3)};
  for (std::size_t i = 0; i < views.size(); ++i) {
    solution.camera_from_target.push_back(pose_of(found->rotations[i], found->translations[i]));
  }
  return solution;
}

double round_to(double value, double step) {
  return std::round(value / step) * step;
}

core::CameraModel rounded(const core::CameraModel& camera) {
  core::CameraModel::Intrinsics intrinsics = camera.intrinsics();
  for (int i = 0; i < 2; ++i) {
    intrinsics.focal_px[i] = round_to(intrinsics.focal_px[i], kPixelStep);
    intrinsics.principal_px[i] = round_to(intrinsics.principal_px[i], kPixelStep);
  }
  for (double& term : intrinsics.distortion) term = round_to(term, kDistortionStep);
  return core::CameraModel(intrinsics);
}

Calibration::View measure_view(const TargetView& points, const LensSolution& solution,
                               std::size_t i) {
  Calibration::View view;
  view.points = points;
  view.camera_from_target = solution.camera_from_target[i];
  const Eigen::Vector2d nowhere(kLeftOut_px, kLeftOut_px);
  double sum = 0;
  for (std::size_t p = 0; p < points.on_target.size(); ++p) {
    const auto predicted = solution.camera.project(view.camera_from_target * points.on_target[p]);
    view.errors_px.push_back(predicted ? points.in_image[p] - *predicted : nowhere);
    sum += view.errors_px.back().squaredNorm();
  }
  view.rms_px = std::sqrt(sum / static_cast<double>(points.on_target.size()));
  return view;
}

/// Share of the image's cells in which a point was seen.
double coverage_of(const std::vector<Calibration::View>& views, const ImageSize& size) {
  std::array<bool, static_cast<std::size_t>(kCoverageColumns * kCoverageRows)> seen{};
  for (const auto& view : views) {
    for (const Eigen::Vector2d& p : view.points.in_image) {
      const int column = static_cast<int>((p.x() + 0.5) / size.width_px * kCoverageColumns);
      const int row = static_cast<int>((p.y() + 0.5) / size.height_px * kCoverageRows);
      if (column < 0 || row < 0 || column >= kCoverageColumns || row >= kCoverageRows) continue;
      seen[static_cast<std::size_t>(row * kCoverageColumns + column)] = true;
    }
  }
  return static_cast<double>(std::count(seen.begin(), seen.end(), true)) /
         static_cast<double>(seen.size());
}

double tilt_spread(const std::vector<Calibration::View>& views) {
  double smallest_cosine = 1;
  for (const auto& a : views) {
    for (const auto& b : views) {
      const double cosine =
          a.camera_from_target.linear().col(2).dot(b.camera_from_target.linear().col(2));
      smallest_cosine = std::min(smallest_cosine, cosine);
    }
  }
  return std::acos(std::clamp(smallest_cosine, -1.0, 1.0));
}

TargetView points_within(const Calibration::View& view, double limit_px) {
  TargetView kept;
  kept.frame_index = view.points.frame_index;
  for (std::size_t i = 0; i < view.errors_px.size(); ++i) {
    if (view.errors_px[i].norm() > limit_px) continue;
    kept.on_target.push_back(view.points.on_target[i]);
    kept.in_image.push_back(view.points.in_image[i]);
  }
  return kept;
}

/// Of `points`, those that were left out being the worst.
double median_error_px(const Calibration& calibration, std::size_t points) {
  std::vector<double> errors_px;
  for (const auto& view : calibration.views) {
    for (const Eigen::Vector2d& error : view.errors_px) errors_px.push_back(error.norm());
  }
  errors_px.resize(points, kLeftOut_px);
  return core::upper_median(errors_px);
}

std::optional<Calibration> calibrate_once(const std::vector<TargetView>& views,
                                          const ImageSize& size, core::LensKind lens) {
  if (views.size() < kMinViews) return std::nullopt;
  auto solution =
      lens == core::LensKind::fisheye ? solve_fisheye(views, size) : solve_rational(views, size);
  if (!solution) return std::nullopt;
  solution->camera = rounded(solution->camera);

  Calibration result;
  result.camera = solution->camera;
  result.focal_sigma_px = solution->focal_sigma_px;
  result.principal_sigma_px = solution->principal_sigma_px;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    result.views.push_back(measure_view(views[i], *solution, i));
    for (const Eigen::Vector2d& error : result.views.back().errors_px) sum += error.squaredNorm();
    count += result.views.back().errors_px.size();
  }
  result.rms_px = std::sqrt(sum / static_cast<double>(count));
  result.coverage = coverage_of(result.views, size);
  result.tilt_spread_rad = tilt_spread(result.views);
  if (!std::isfinite(result.rms_px)) return std::nullopt;
  return result;
}

}  // namespace

std::vector<TargetView> choose_spread_views(std::vector<TargetView> views, const ImageSize& size,
                                            std::size_t count) {
  if (views.size() <= count) return views;
  std::vector<Signature> signatures;
  for (const TargetView& view : views) signatures.push_back(signature_of(view, size));

  // Begin with the view of most points, then always take the one farthest from those taken.
  std::vector<double> distance(views.size(), std::numeric_limits<double>::infinity());
  std::size_t next =
      static_cast<std::size_t>(std::max_element(views.begin(), views.end(),
                                                [](const TargetView& a, const TargetView& b) {
                                                  return a.on_target.size() < b.on_target.size();
                                                }) -
                               views.begin());
  std::vector<std::size_t> taken;
  while (taken.size() < count) {
    taken.push_back(next);
    for (std::size_t i = 0; i < views.size(); ++i) {
      distance[i] = std::min(distance[i], squared_distance(signatures[i], signatures[next]));
    }
    next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) -
                                    distance.begin());
  }
  std::sort(taken.begin(), taken.end());
  std::vector<TargetView> chosen;
  for (const std::size_t i : taken) chosen.push_back(std::move(views[i]));
  return chosen;
}

std::optional<Calibration> calibrate_camera(const std::vector<TargetView>& views,
                                            const ImageSize& size, core::LensKind lens) {
  const auto first = calibrate_once(views, size, lens);
  if (!first) return std::nullopt;

  // Points far above the rest are half hidden or cut; a view without enough of the others goes.
  std::vector<double> errors_px;
  for (const auto& view : first->views) {
    for (const Eigen::Vector2d& error : view.errors_px) errors_px.push_back(error.norm());
  }
  const double limit_px = std::max(kAlwaysFinePx, kFarAbove * core::upper_median(errors_px));
  std::vector<TargetView> kept;
  std::vector<int> dropped;
  for (const auto& view : first->views) {
    TargetView points = points_within(view, limit_px);
    if (2 * points.on_target.size() >= view.points.on_target.size()) {
      kept.push_back(std::move(points));
    } else {
      dropped.push_back(view.points.frame_index);
    }
  }
  auto second = calibrate_once(kept, size, lens);
  if (!second) return std::nullopt;
  second->dropped = dropped;
  second->median_px = median_error_px(*second, errors_px.size());
  return second;
}

std::vector<std::string> find_faults(const Calibration& calibration,
                                     const CalibrationLimits& limits) {
  std::vector<std::string> faults;
  const auto& lens = calibration.camera.intrinsics();
  const double tilt_deg = calibration.tilt_spread_rad * 180 / std::numbers::pi;
  const double side = std::max(lens.width_px, lens.height_px);
  if (static_cast<int>(calibration.views.size()) < limits.min_views) {
    faults.push_back(fmt::format("only {} images show the target, {} are needed",
                                 calibration.views.size(), limits.min_views));
  }
  if (calibration.rms_px > limits.max_rms_px) {
    faults.push_back(
        fmt::format("the points miss by {:.1f} px, the target is not flat or not the one given",
                    calibration.rms_px));
  }
  if (tilt_deg < limits.min_tilt_spread_deg) {
    faults.push_back(fmt::format(
        "the views are too alike, their tilts differ by {:.0f} degrees, {:.0f} are needed",
        tilt_deg, limits.min_tilt_spread_deg));
  }
  if (calibration.coverage < limits.min_coverage) {
    faults.push_back(
        fmt::format("points cover {:.0f} % of the image, {:.0f} % are needed: bring the target "
                    "to its borders and corners",
                    100 * calibration.coverage, 100 * limits.min_coverage));
  }
  const double focal_sigma = calibration.focal_sigma_px.cwiseQuotient(lens.focal_px).maxCoeff();
  if (!(focal_sigma <= limits.max_focal_sigma)) {
    faults.push_back(
        std::isfinite(focal_sigma)
            ? fmt::format("the focal length is known to {:.1f} % only", 100 * focal_sigma)
            : std::string("the focal length is not known at all"));
  }
  const double principal_sigma = calibration.principal_sigma_px.maxCoeff() / side;
  if (!(principal_sigma <= limits.max_principal_sigma)) {
    faults.push_back(
        fmt::format("the principal point is known to {:.0f} px only", side * principal_sigma));
  }
  // A fisheye's corners may be dark.
  if (lens.lens == core::LensKind::fisheye) return faults;
  for (const double x : {0.0, lens.width_px - 1.0}) {
    for (const double y : {0.0, lens.height_px - 1.0}) {
      if (calibration.camera.unproject({x, y})) continue;
      faults.emplace_back("the lens model folds over in a corner where no point was seen");
      return faults;
    }
  }
  return faults;
}

std::optional<LensDoubt> doubt_lens(core::LensKind chosen, const std::optional<Calibration>& found,
                                    const std::optional<Calibration>& other,
                                    const CalibrationLimits& limits) {
  if (!other || !find_faults(*other, limits).empty()) return std::nullopt;
  const bool is_fisheye = chosen == core::LensKind::fisheye;
  const auto faults =
      found ? find_faults(*found, limits) : std::vector<std::string>{"no such lens fits"};
  const double own_px = found ? found->median_px : std::numeric_limits<double>::infinity();
  const double other_px = other->median_px;
  LensDoubt doubt{fmt::format("{} explains the points to {:.2f} px (median), {} to {:.2f} px",
                              is_fisheye ? "a plain lens" : "a fisheye", other_px,
                              is_fisheye ? "a fisheye" : "a plain lens", own_px),
                  is_fisheye ? "leave --fisheye out" : "add --fisheye"};
  if (!faults.empty() && other_px <= own_px) {
    doubt.fault += "; " + faults.front();
    doubt.is_sure = true;
    return doubt;
  }
  if (other_px < kBetter * own_px) {
    doubt.is_sure = other_px < kSurelyBetter * own_px;
    return doubt;
  }
  // A plain lens with small errors at its corners can be told by its field of view only.
  const auto& lens = other->camera.intrinsics();
  const double view_rad = 2 * std::atan(lens.width_px / 2.0 / lens.focal_px.x());
  if (!is_fisheye || view_rad > kNarrow_rad || other_px > kAsGood * own_px) return std::nullopt;
  doubt.fault +=
      fmt::format(", and the field of view is {:.0f} degrees", view_rad * 180 / std::numbers::pi);
  return doubt;
}

}  // namespace sheen::capture
