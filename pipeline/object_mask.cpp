// SPDX-License-Identifier: MIT
#include "pipeline/object_mask.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sheen::pipeline {
namespace {

/// Pixels that the mesh can be seen in: those between its projected vertices and some more, since
/// edges between them may bend; all when a vertex cannot be projected.
cv::Rect reach_of(const core::Mesh& mesh, const core::CameraModel& camera,
                  const Eigen::Isometry3d& camera_from_object) {
  constexpr double bend = 0.1;  // of the reach, to either side
  const cv::Rect all(0, 0, camera.width_px(), camera.height_px());
  Eigen::AlignedBox2d reach;
  for (const Eigen::Vector3f& position : mesh.positions) {
    const auto pixel = camera.project(camera_from_object * position.cast<double>());
    if (!pixel) return all;
    reach.extend(*pixel);
  }
  const Eigen::Vector2d margin = bend * reach.sizes() + Eigen::Vector2d::Ones();
  const Eigen::Vector2d size(all.width, all.height);
  const Eigen::Vector2d lower = (reach.min() - margin).array().floor().max(0).min(size.array());
  const Eigen::Vector2d upper = (reach.max() + margin).array().ceil().max(0).min(size.array());
  return cv::Rect(cv::Point(static_cast<int>(lower.x()), static_cast<int>(lower.y())),
                  cv::Point(static_cast<int>(upper.x()), static_cast<int>(upper.y())));
}

}  // namespace

ObjectMask::ObjectMask(const core::Mesh& mesh, int threads)
    : mesh_(mesh), rays_(mesh), threads_(threads) {}

cv::Mat ObjectMask::draw(const core::CameraModel& camera,
                         const Eigen::Isometry3d& camera_from_object) const {
  cv::Mat mask = cv::Mat::zeros(camera.height_px(), camera.width_px(), CV_8UC1);
  const cv::Rect reach = reach_of(mesh_, camera, camera_from_object);
  const Eigen::Isometry3d object_from_camera = camera_from_object.inverse();
  const Eigen::Vector3f eye = object_from_camera.translation().cast<float>();
  constexpr std::size_t rows_of_a_thread = 8;
  core::parallel_for(
      static_cast<std::size_t>(reach.height), threads_,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
          const int y = reach.y + static_cast<int>(row);
          for (int x = reach.x; x < reach.x + reach.width; ++x) {
            const auto ray = camera.unproject({x, y});
            if (!ray) continue;
            const Eigen::Vector3f direction =
                (object_from_camera.linear() * *ray).cast<float>().eval();
            const bool meets =
                rays_.occluded(eye, direction, 0, std::numeric_limits<float>::infinity());
            mask.at<std::uint8_t>(y, x) = meets ? 255 : 0;
          }
        }
      },
      rows_of_a_thread);
  return mask;
}

}  // namespace sheen::pipeline
