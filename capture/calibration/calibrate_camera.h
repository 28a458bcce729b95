// SPDX-License-Identifier: MIT
#pragma once

#include "capture/calibration/calibration_target.h"
#include "capture/source/frame_range.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace sheen::capture {

/// A camera with what speaks for it and against it.
struct Calibration {
  /// One image that took part.
  struct View {
    TargetView points;
    Eigen::Isometry3d camera_from_target = Eigen::Isometry3d::Identity();
    std::vector<Eigen::Vector2d> errors_px;  ///< seen minus predicted, per point
    double rms_px = 0;                       ///< over its points
  };
  core::CameraModel camera;
  Eigen::Vector2d focal_sigma_px{0, 0};      ///< standard deviations, from the residuals
  Eigen::Vector2d principal_sigma_px{0, 0};  ///< likewise
  double rms_px = 0;                         ///< over all points
  double median_px = 0;  ///< of the errors of all points, those left out being the worst
  std::vector<View> views;
  std::vector<int> dropped;    ///< frames most of whose points fitted far worse than the others'
  double coverage = 0;         ///< share of the image area (kCoverageCells) with points, [0, 1]
  double tilt_spread_rad = 0;  ///< largest angle between two planes of the target, camera frame
};

/// Cells across and down by which coverage is counted.
inline constexpr int kCoverageColumns = 10;
inline constexpr int kCoverageRows = 8;

/// At most `count` views that differ most in place, size and perspective of the target.
std::vector<TargetView> choose_spread_views(std::vector<TargetView> views, const ImageSize& size,
                                            std::size_t count);

/// OpenCV's calibration with k1 k2 p1 p2 and, where the images tell it from zero, k3; of a fisheye
/// ours (lens_solution.h). Points whose error is far above the others' are dropped, and views that
/// lose half of theirs. Nothing for fewer than three views or when no lens fits.
std::optional<Calibration> calibrate_camera(const std::vector<TargetView>& views,
                                            const ImageSize& size,
                                            core::LensKind lens = core::LensKind::rational);

/// What a calibration must show to be believed.
struct CalibrationLimits {
  int min_views = 8;
  double min_tilt_spread_deg = 20;     ///< less leaves focal length and distance entangled
  double min_coverage = 0.4;           ///< less leaves the lens unmeasured where the object may be
  double max_focal_sigma = 0.005;      ///< of the focal length
  double max_principal_sigma = 0.005;  ///< of the image's longer side
  double max_rms_px = 1.5;             ///< more: the target is not what was said
};

/// Why a calibration cannot be believed, each with what to do; empty: it can.
std::vector<std::string> find_faults(const Calibration& calibration,
                                     const CalibrationLimits& limits);

/// What speaks for the other kind of lens, with the median errors of both.
struct LensDoubt {
  std::string fault;
  std::string remedy;
  bool is_sure = false;  ///< the chosen kind cannot be right
};

/// Compares calibrations of the same images as the kind of lens that was chosen and as the other
/// one. Nothing where the chosen one is the better one, or where neither can be believed.
std::optional<LensDoubt> doubt_lens(core::LensKind chosen, const std::optional<Calibration>& found,
                                    const std::optional<Calibration>& other,
                                    const CalibrationLimits& limits);

}  // namespace sheen::capture
