// SPDX-License-Identifier: MIT
#include "capture/registration/colour_learning.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace sheen::capture {
namespace {

constexpr int kLeastStep_px = 3;     // of the grid on which pixels are looked at
constexpr int kNodeStep_px = 24;     // between pixels whose rays are computed; others lie between
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

/// Rays through the pixels of a region, bilinear between computed ones: taking a lens's distortion
/// out of every pixel costs more than all the rest.
class RayGrid {
 public:
  RayGrid(const cv::Rect& box, const core::CameraModel& camera)
      : columns_(box.width / kNodeStep_px + 2) {
    for (int row = 0; row < box.height / kNodeStep_px + 2; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const auto ray =
            camera.unproject({box.x + column * kNodeStep_px, box.y + row * kNodeStep_px});
        nodes_.push_back(ray.value_or(Eigen::Vector3d::Constant(std::nan(""))));
      }
    }
  }

  /// Through the pixel so far from the region's first; not a number where the lens sees nothing.
  [[nodiscard]] Eigen::Vector3d at(int x, int y) const {
    const double u = static_cast<double>(x % kNodeStep_px) / kNodeStep_px;
    const double v = static_cast<double>(y % kNodeStep_px) / kNodeStep_px;
    const auto first = static_cast<std::size_t>(y / kNodeStep_px * columns_ + x / kNodeStep_px);
    const std::size_t below = first + static_cast<std::size_t>(columns_);
    return (1 - v) * ((1 - u) * nodes_[first] + u * nodes_[first + 1]) +
           v * ((1 - u) * nodes_[below] + u * nodes_[below + 1]);
  }

 private:
  int columns_;
  std::vector<Eigen::Vector3d> nodes_;
};

/// 0 where the object is seen, 255 elsewhere, on a grid of `step_px` over `box`.
cv::Mat outside_mask(const cv::Rect& box, int step_px, const ContourFinder& contours,
                     const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object) {
  const RayGrid rays(box, camera);
  const Eigen::Isometry3d object_from_camera = camera_from_object.inverse();
  cv::Mat outside((box.height + step_px - 1) / step_px, (box.width + step_px - 1) / step_px,
                  CV_8UC1);
  for (int row = 0; row < outside.rows; ++row) {
    for (int column = 0; column < outside.cols; ++column) {
      const Eigen::Vector3d ray = rays.at(column * step_px, row * step_px);
      const bool is_seen = ray.allFinite() && contours.meets(object_from_camera, ray);
      outside.at<std::uint8_t>(row, column) = is_seen ? 0 : 255;
    }
  }
  return outside;
}

}  // namespace

void learn_colours_of(const cv::Mat& image, const ContourFinder& contours,
                      const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                      double reach_px, int most_pixels, ColourStatistics& colours) {
  const cv::Rect box =
      box_around(contours, camera, camera_from_object, kSurroundings * reach_px + 4);
  if (box.area() == 0) return;
  const int step_px = std::max(
      kLeastStep_px, static_cast<int>(std::sqrt(static_cast<double>(box.area()) / most_pixels)));
  const cv::Mat outside = outside_mask(box, step_px, contours, camera, camera_from_object);
  cv::Mat to_object;
  cv::Mat to_outside;
  cv::distanceTransform(outside, to_object, cv::DIST_L2, 3);
  cv::distanceTransform(255 - outside, to_outside, cv::DIST_L2, 3);
  const auto clearance = static_cast<float>(kClearance * reach_px / step_px);
  for (int row = 0; row < outside.rows; ++row) {
    for (int column = 0; column < outside.cols; ++column) {
      const bool is_inner = to_outside.at<float>(row, column) > clearance;
      if (!is_inner && !(to_object.at<float>(row, column) > clearance)) continue;
      colours.add(image.at<cv::Vec3b>(box.y + row * step_px, box.x + column * step_px), is_inner);
    }
  }
}

}  // namespace sheen::capture
