// SPDX-License-Identifier: MIT
#include "capture/calibration/lens_record.h"

#include "core/diagnostics/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sheen::capture {
namespace {

constexpr int kMaxSidePx = 1 << 15;

void check_size(const LensRecord& record, const std::filesystem::path& path) {
  for (const auto& [name, side] :
       {std::pair("image_width", record.width_px), std::pair("image_height", record.height_px)}) {
    if (side < 1 || side > kMaxSidePx)
      refuse_camera_file(path, std::string(name) + " is out of range");
  }
}

void check_matrix(const LensRecord& record, const std::filesystem::path& path) {
  const double longer = std::max(record.width_px, record.height_px);
  const double least = record.focal_px.minCoeff(), most = record.focal_px.maxCoeff();
  if (!record.focal_px.allFinite() || !record.principal_px.allFinite()) {
    refuse_camera_file(path, "camera_matrix holds a number not finite");
  }
  if (!(least > 0) || most > 1e3 * longer) {
    refuse_camera_file(path, "the focal lengths are not positive or not believable");
  }
  if (most < 0.1 * longer) {
    const bool is_fisheye = record.kind == core::LensKind::fisheye;
    const double view = is_fisheye ? longer / most : 2 * std::atan(longer / 2 / most);
    refuse_camera_file(
        path,
        fmt::format(
            "a focal length of {:.4g} px for images {} px wide is a view of {:.0f} degrees, "
            "which no such lens has",
            most, record.width_px, view * 180 / std::numbers::pi),
        "give the focal length in pixels, not in millimetres");
  }
  if (most > 2 * least) {
    refuse_camera_file(
        path, fmt::format("the focal lengths {:.4g} and {:.4g} px differ too much for any camera",
                          record.focal_px.x(), record.focal_px.y()));
  }
  // Half an image outside still leaves room for crops.
  const Eigen::Vector2d size(record.width_px, record.height_px);
  const Eigen::Vector2d relative = record.principal_px.cwiseQuotient(size);
  if (!(relative.minCoeff() > -0.5) || !(relative.maxCoeff() < 1.5)) {
    refuse_camera_file(path, "the principal point lies far outside the image");
  }
  if (most > 2 && relative.cwiseAbs().maxCoeff() < 2.0 / longer && longer > 100) {
    refuse_camera_file(path, "the principal point lies in the corner of the image",
                       "give cx and cy in pixels from the image's upper left corner");
  }
}

/// Those of a rational lens; the ones that the model lacks must be zero.
std::array<double, 8> rational_coefficients(const std::vector<double>& k,
                                            const std::filesystem::path& path) {
  constexpr std::size_t modelled = 8;
  const std::size_t n = k.size();
  if (n != 0 && n != 4 && n != 5 && n != 8 && n != 12 && n != 14) {
    refuse_camera_file(
        path,
        fmt::format("distortion_coefficients has {} entries, only 4, 5 or 8 are understood", n));
  }
  if (std::any_of(k.begin() + static_cast<std::ptrdiff_t>(std::min(n, modelled)), k.end(),
                  [](double value) { return value != 0; })) {
    refuse_camera_file(
        path,
        fmt::format(
            "distortion_coefficients has {} entries: a thin prism or a tilted sensor, which "
            "is not modelled",
            n),
        "calibrate without those terms (4, 5 or 8 coefficients)");
  }
  std::array<double, 8> coefficients{};
  std::copy_n(k.begin(), std::min(n, modelled), coefficients.begin());
  return coefficients;
}

/// Those of a fisheye. OpenCV's own sample writes a fifth, which is zero.
std::array<double, 8> fisheye_coefficients(const std::vector<double>& k,
                                           const std::filesystem::path& path) {
  constexpr std::size_t modelled = 4;
  const bool has_more =
      std::any_of(k.begin() + static_cast<std::ptrdiff_t>(std::min(k.size(), modelled)), k.end(),
                  [](double value) { return value != 0; });
  if (has_more || (!k.empty() && k.size() < modelled)) {
    refuse_camera_file(
        path, fmt::format("a fisheye lens has 4 coefficients, k1 to k4, not {}", k.size()));
  }
  std::array<double, 8> coefficients{};
  std::copy_n(k.begin(), std::min(k.size(), modelled), coefficients.begin());
  return coefficients;
}

}  // namespace

void refuse_camera_file(const std::filesystem::path& path, const std::string& fault,
                        const std::string& remedy) {
  throw core::bad_input(path, fault, remedy);
}

core::CameraModel camera_of(const LensRecord& record, const std::filesystem::path& path) {
  check_size(record, path);
  check_matrix(record, path);
  for (const double coefficient : record.distortion) {
    if (!std::isfinite(coefficient))
      refuse_camera_file(path, "distortion_coefficients holds a number not finite");
  }
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = record.width_px;
  intrinsics.height_px = record.height_px;
  intrinsics.focal_px = record.focal_px;
  intrinsics.principal_px = record.principal_px;
  intrinsics.lens = record.kind;
  intrinsics.distortion = record.kind == core::LensKind::fisheye
                              ? fisheye_coefficients(record.distortion, path)
                              : rational_coefficients(record.distortion, path);
  core::CameraModel camera(intrinsics);
  if (!(camera.valid_radius() > 0.01))
    refuse_camera_file(path, "the distortion folds the image over");
  return camera;
}

}  // namespace sheen::capture
