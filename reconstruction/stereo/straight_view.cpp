// SPDX-License-Identifier: MIT
#include "reconstruction/stereo/straight_view.h"

#include "core/concurrency/parallel_for.h"
#include "reconstruction/views/depth_image.h"

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

namespace sheen::reconstruction {
namespace {

constexpr int kOutlineBlur_px = 2;  // by which the hull's may lie wrong, and bilinear reading

core::CameraModel without_distortion(const core::CameraModel& camera) {
  core::CameraModel::Intrinsics intrinsics = camera.intrinsics();
  intrinsics.distortion = {};
  intrinsics.lens = core::LensKind::rational;
  return core::CameraModel(intrinsics);
}

/// Where each straight pixel lies in the images (CV_32FC2); outside of them beyond the lens.
cv::Mat places_in_image(const core::CameraModel& camera, const Eigen::Matrix3d& ray_of_pixel) {
  cv::Mat places(camera.height_px(), camera.width_px(), CV_32FC2);
  for (int y = 0; y < places.rows; ++y) {
    auto* row = places.ptr<cv::Vec2f>(y);
    for (int x = 0; x < places.cols; ++x) {
      const auto pixel = camera.project(ray_of_pixel * Eigen::Vector3d(x, y, 1));
      row[x] = pixel ? cv::Vec2f(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()))
                     : cv::Vec2f(-1, -1);
    }
  }
  return places;
}

cv::Mat straight_luma(const cv::Mat& image, const cv::Mat& places) {
  cv::Mat luma;
  cv::Mat straight;
  cv::cvtColor(image, luma, cv::COLOR_BGR2GRAY);
  cv::remap(luma, straight, places, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  straight.convertTo(luma, CV_32FC1, 1.0 / 255);
  return luma;
}

}  // namespace

std::vector<StraightView> straighten(const ViewSet& views, const core::Mesh& hull, int threads) {
  const core::CameraModel camera = without_distortion(views.camera);
  const auto& intrinsics = camera.intrinsics();
  Eigen::Matrix3d pixel_of_ray = Eigen::Matrix3d::Identity();
  pixel_of_ray.diagonal().head<2>() = intrinsics.focal_px;
  pixel_of_ray.col(2).head<2>() = intrinsics.principal_px;
  const Eigen::Matrix3d ray_of_pixel = pixel_of_ray.inverse();
  const cv::Mat places = places_in_image(views.camera, ray_of_pixel);
  constexpr int side = 1 + 2 * kOutlineBlur_px;
  const cv::Mat element = cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
  std::vector<StraightView> straight(views.views.size());
  core::parallel_for(
      straight.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          const Eigen::Isometry3d& pose = views.views[v].camera_from_board;
          const Projection project(camera, pose);
          const cv::Mat depth = draw_depth(hull, project).depth;
          cv::Mat is_object;
          cv::erode(depth > 0, is_object, element, {-1, -1}, 1, cv::BORDER_REFLECT);
          straight[v] = {straight_luma(views.views[v].image, places),
                         depth,
                         is_object,
                         (pixel_of_ray * pose.linear()).cast<float>(),
                         (pixel_of_ray * pose.translation()).cast<float>(),
                         (pose.linear().transpose() * ray_of_pixel).cast<float>(),
                         project};
        }
      },
      1);
  return straight;
}

}  // namespace sheen::reconstruction
