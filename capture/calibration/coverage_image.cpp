// SPDX-License-Identifier: MIT
#include "capture/calibration/coverage_image.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace sheen::capture {
namespace {

constexpr double kWidthPx = 960;
constexpr int kMarginPx = 16;
constexpr int kLegendPx = 34;
constexpr double kArrowPx = 14;  // length that stands for the overall error
const cv::Scalar kPaper(250, 250, 250);
const cv::Scalar kEmptyCell(205, 222, 246);
const cv::Scalar kLine(215, 215, 215);
const cv::Scalar kInk(60, 55, 50);
const cv::Scalar kSmall(190, 125, 45);
const cv::Scalar kLarge(40, 60, 210);

cv::Point subpixel(const cv::Point2d& p) {
  return {cvRound(p.x * 16), cvRound(p.y * 16)};  // 4 fractional bits
}

/// From blue (fits) to red (twice the overall error and more).
cv::Scalar colour_of(double error_px, double rms_px) {
  const double share = std::clamp(error_px / std::max(2 * rms_px, 1e-9), 0.0, 1.0);
  return (1 - share) * kSmall + share * kLarge;
}

void draw_cells(cv::Mat& image, const cv::Rect& frame, const Calibration& calibration) {
  cv::Mat counts = cv::Mat::zeros(kCoverageRows, kCoverageColumns, CV_32S);
  const auto& lens = calibration.camera.intrinsics();
  for (const auto& view : calibration.views) {
    for (const Eigen::Vector2d& p : view.points.in_image) {
      const int column = static_cast<int>((p.x() + 0.5) / lens.width_px * kCoverageColumns);
      const int row = static_cast<int>((p.y() + 0.5) / lens.height_px * kCoverageRows);
      if (column < 0 || row < 0 || column >= kCoverageColumns || row >= kCoverageRows) continue;
      ++counts.at<int>(row, column);
    }
  }
  for (int row = 0; row < kCoverageRows; ++row) {
    for (int column = 0; column < kCoverageColumns; ++column) {
      const cv::Rect cell(cv::Point(frame.x + frame.width * column / kCoverageColumns,
                                    frame.y + frame.height * row / kCoverageRows),
                          cv::Point(frame.x + frame.width * (column + 1) / kCoverageColumns,
                                    frame.y + frame.height * (row + 1) / kCoverageRows));
      const bool is_empty = counts.at<int>(row, column) == 0;
      cv::rectangle(image, cell, is_empty ? kEmptyCell : kPaper, cv::FILLED);
      cv::rectangle(image, cell, kLine, 1);
    }
  }
}

}  // namespace

cv::Mat draw_coverage(const Calibration& calibration) {
  const auto& lens = calibration.camera.intrinsics();
  const double scale = kWidthPx / lens.width_px;
  const cv::Rect frame(kMarginPx, kMarginPx, static_cast<int>(kWidthPx),
                       static_cast<int>(scale * lens.height_px));
  cv::Mat image(frame.height + 2 * kMarginPx + kLegendPx, frame.width + 2 * kMarginPx, CV_8UC3,
                kPaper);
  draw_cells(image, frame, calibration);

  const double factor = kArrowPx / std::max(calibration.rms_px * scale, 1e-9);
  for (const auto& view : calibration.views) {
    for (std::size_t i = 0; i < view.errors_px.size(); ++i) {
      const Eigen::Vector2d seen = scale * view.points.in_image[i];
      const Eigen::Vector2d error = (factor * scale) * view.errors_px[i];
      const cv::Point2d from(frame.x + seen.x(), frame.y + seen.y());
      // An outlier's arrow ends after four times the usual length.
      const double length = error.norm();
      const double shown = std::min(length, 4 * kArrowPx) / std::max(length, 1e-9);
      const cv::Point2d to = from + shown * cv::Point2d(error.x(), error.y());
      const cv::Scalar colour = colour_of(view.errors_px[i].norm(), calibration.rms_px);
      cv::line(image, subpixel(from), subpixel(to), colour, 1, cv::LINE_AA, 4);
      cv::circle(image, subpixel(from), 24, colour, cv::FILLED, cv::LINE_AA, 4);
    }
  }
  const cv::Point centre(frame.x + cvRound(scale * lens.principal_px.x()),
                         frame.y + cvRound(scale * lens.principal_px.y()));
  cv::drawMarker(image, centre, kInk, cv::MARKER_CROSS, 18, 1, cv::LINE_AA);
  cv::putText(
      image,
      fmt::format("{} views, {:.2f} px RMS, {:.0f} % of the image covered; arrows: error "
                  "{:.0f} x; cross: principal point; shaded: no point",
                  calibration.views.size(), calibration.rms_px, 100 * calibration.coverage, factor),
      {kMarginPx, image.rows - 16}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
  return image;
}

}  // namespace sheen::capture
