// SPDX-License-Identifier: MIT
#include "capture/registration/colour_learning.h"

#include <opencv2/imgproc.hpp>

#include <cstdint>

namespace sheen::capture {
namespace {

constexpr int kStepPx = 3;           // of the grid on which pixels are looked at
constexpr double kClearance = 0.35;  // of the reach: thin parts of the object must keep some pixels
constexpr double kSurroundings = 2.5;  // of the reach, how far round the object

/// Bounding box of the object in an image, grown by a margin and cut to the image.
cv::Rect box_around(const ContourFinder& contours, const core::CameraModel& camera,
                    const Eigen::Isometry3d& camera_from_object, double margin_px) {
  Eigen::AlignedBox2d box;
  for (int corner = 0; corner < 8; ++corner) {
    const auto pixel = camera.project(
        camera_from_object *
        contours.bounds().corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    if (pixel) box.extend(*pixel);
  }
  if (box.isEmpty()) return {};
  const Eigen::Vector2d size(camera.width_px(), camera.height_px());
  const Eigen::Vector2d low = (box.min().array() - margin_px).max(0);
  const Eigen::Vector2d high = (box.max().array() + margin_px).min(size.array());
  if (!(low.x() < high.x() && low.y() < high.y())) return {};
  return {cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
          cv::Point(static_cast<int>(high.x()), static_cast<int>(high.y()))};
}

/// 0 where the object is seen, 255 elsewhere, on a grid of kStepPx over `box`.
cv::Mat outside_mask(const cv::Rect& box, const ContourFinder& contours,
                     const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object) {
  cv::Mat outside((box.height + kStepPx - 1) / kStepPx, (box.width + kStepPx - 1) / kStepPx,
                  CV_8UC1);
  for (int row = 0; row < outside.rows; ++row) {
    for (int column = 0; column < outside.cols; ++column) {
      const Eigen::Vector2d pixel(box.x + column * kStepPx, box.y + row * kStepPx);
      outside.at<std::uint8_t>(row, column) =
          contours.covers(camera, camera_from_object, pixel) ? 0 : 255;
    }
  }
  return outside;
}

}  // namespace

void learn_colours_of(const cv::Mat& image, const ContourFinder& contours,
                      const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                      double reach_px, ColourStatistics& colours) {
  const cv::Rect box =
      box_around(contours, camera, camera_from_object, kSurroundings * reach_px + 4);
  if (box.area() == 0) return;
  const cv::Mat outside = outside_mask(box, contours, camera, camera_from_object);
  cv::Mat to_object;
  cv::Mat to_outside;
  cv::distanceTransform(outside, to_object, cv::DIST_L2, 3);
  cv::distanceTransform(255 - outside, to_outside, cv::DIST_L2, 3);
  const auto clearance = static_cast<float>(kClearance * reach_px / kStepPx);
  for (int row = 0; row < outside.rows; ++row) {
    for (int column = 0; column < outside.cols; ++column) {
      const bool is_inner = to_outside.at<float>(row, column) > clearance;
      if (!is_inner && !(to_object.at<float>(row, column) > clearance)) continue;
      colours.add(image.at<cv::Vec3b>(box.y + row * kStepPx, box.x + column * kStepPx), is_inner);
    }
  }
}

}  // namespace sheen::capture
