// SPDX-License-Identifier: MIT
#include "capture/registration/registration_image.h"

#include "capture/registration/contour.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace sheen::capture {
namespace {

constexpr int kColumns = 3;
constexpr int kCellWidth = 420;
constexpr int kCellHeight = 320;
constexpr int kGap = 8;
constexpr int kLegendHeight = 34;
constexpr double kAir = 1.25;         // of the cut-out against the object
constexpr double kOutlineStep = 0.4;  // px of the photograph: dots run into a line
const cv::Scalar kPaper(250, 250, 250);
const cv::Scalar kInk(60, 55, 50);
const cv::Scalar kBefore(30, 140, 255);
const cv::Scalar kAfter(235, 120, 20);

/// Part of a photograph, scaled to a cell.
struct Crop {
  Eigen::Vector2d corner;  ///< px of the photograph, of the cell's upper left pixel
  double scale = 1;

  [[nodiscard]] cv::Point subpixel(const Eigen::Vector2d& pixel) const {
    constexpr double fixed_point = 16;  // 4 fractional bits
    const Eigen::Vector2d at = ((pixel - corner) * scale).cwiseMax(-500).cwiseMin(5000);
    return {static_cast<int>(std::lround(at.x() * fixed_point)),
            static_cast<int>(std::lround(at.y() * fixed_point))};
  }
};

Crop crop_around(const std::vector<ContourPoint>& a, const std::vector<ContourPoint>& b,
                 const core::CameraModel& camera) {
  Eigen::AlignedBox2d box;
  for (const auto* points : {&a, &b}) {
    for (const ContourPoint& point : *points) box.extend(point.pixel);
  }
  if (box.isEmpty()) {
    box.extend(Eigen::Vector2d(0, 0));
    box.extend(Eigen::Vector2d(camera.width_px(), camera.height_px()));
  }
  const double width = std::max({box.sizes().x(), box.sizes().y() * kCellWidth / kCellHeight, 8.0});
  Crop crop;
  crop.scale = kCellWidth / (kAir * width);
  crop.corner = box.center() - Eigen::Vector2d(kCellWidth, kCellHeight) / (2 * crop.scale);
  return crop;
}

void draw_outline(cv::Mat& cell, const Crop& crop, const std::vector<ContourPoint>& points,
                  const cv::Scalar& colour) {
  for (const ContourPoint& point : points) {
    cv::circle(cell, crop.subpixel(point.pixel), 14, colour, cv::FILLED, cv::LINE_AA, 4);
  }
}

cv::Mat draw_cell(const ContourFinder& contours, const core::CameraModel& camera,
                  const RegistrationView& view, const std::string& label,
                  const Eigen::Isometry3d& before, const Eigen::Isometry3d& after) {
  const auto old_outline = contours.find(camera, view.camera_from_board * before, kOutlineStep);
  const auto new_outline = contours.find(camera, view.camera_from_board * after, kOutlineStep);
  const Crop crop = crop_around(old_outline, new_outline, camera);
  const cv::Matx23d cell_from_photograph(crop.scale, 0, -crop.scale * crop.corner.x(), 0,
                                         crop.scale, -crop.scale * crop.corner.y());
  cv::Mat cell;
  cv::warpAffine(view.image, cell, cell_from_photograph, {kCellWidth, kCellHeight},
                 crop.scale < 1 ? cv::INTER_AREA : cv::INTER_CUBIC, cv::BORDER_CONSTANT, kPaper);
  draw_outline(cell, crop, old_outline, kBefore);
  draw_outline(cell, crop, new_outline, kAfter);
  cv::rectangle(cell, cv::Rect(0, kCellHeight - 20, 8 + 9 * static_cast<int>(label.size()), 20),
                kPaper, cv::FILLED);
  cv::putText(cell, label, {6, kCellHeight - 6}, cv::FONT_HERSHEY_SIMPLEX, 0.42, kInk, 1,
              cv::LINE_AA);
  return cell;
}

}  // namespace

cv::Mat draw_registration(const core::Mesh& mesh, const core::CameraModel& camera,
                          const std::vector<RegistrationView>& views,
                          const std::vector<std::string>& labels, const Eigen::Isometry3d& before,
                          const Eigen::Isometry3d& after) {
  const ContourFinder contours(mesh);
  const int count = static_cast<int>(views.size());
  const int columns = std::clamp(count, 1, kColumns);
  const int rows = (count + columns - 1) / columns;
  cv::Mat sheet(kLegendHeight + rows * (kCellHeight + kGap) + kGap,
                columns * (kCellWidth + kGap) + kGap, CV_8UC3, kPaper);
  const auto write = [&](const char* text, int left, const cv::Scalar& colour) {
    cv::putText(sheet, text, {left, 22}, cv::FONT_HERSHEY_SIMPLEX, 0.5, colour, 1, cv::LINE_AA);
  };
  if (before.isApprox(after)) {
    write("blue: the mesh's outline", kGap + 4, kAfter);
  } else {
    write("orange: before", kGap + 4, kBefore);
    write("blue: after", kGap + 150, kAfter);
  }
  for (int i = 0; i < count; ++i) {
    const cv::Rect place(kGap + (i % columns) * (kCellWidth + kGap),
                         kLegendHeight + (i / columns) * (kCellHeight + kGap), kCellWidth,
                         kCellHeight);
    const auto v = static_cast<std::size_t>(i);
    draw_cell(contours, camera, views[v], labels[v], before, after).copyTo(sheet(place));
  }
  return sheet;
}

}  // namespace sheen::capture
