// SPDX-License-Identifier: MIT
#include "reconstruction/stereo/straight_view.h"

#include "core/concurrency/parallel_for.h"
#include "core/image/undistortion.h"
#include "reconstruction/views/depth_image.h"

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

namespace sheen::reconstruction {
namespace {

constexpr int kOutlineBlur_px = 2;  // by which the hull's may lie wrong, and bilinear reading

cv::Mat luma_of(const cv::Mat& image) {
  cv::Mat grey;
  cv::Mat luma;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(luma, CV_32FC1, 1.0 / 255);
  return luma;
}

}  // namespace

std::vector<StraightView> straighten(const ViewSet& views, const core::Mesh& hull, int threads) {
  const core::Undistortion undistortion(views.camera);
  const auto& intrinsics = undistortion.camera().intrinsics();
  Eigen::Matrix3d pixel_of_ray = Eigen::Matrix3d::Identity();
  pixel_of_ray.diagonal().head<2>() = intrinsics.focal_px;
  pixel_of_ray.col(2).head<2>() = intrinsics.principal_px;
  const Eigen::Matrix3d ray_of_pixel = pixel_of_ray.inverse();
  constexpr int side = 1 + 2 * kOutlineBlur_px;
  const cv::Mat element = cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
  std::vector<StraightView> straight(views.views.size());
  core::parallel_for(
      straight.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          const Eigen::Isometry3d& pose = views.views[v].camera_from_board;
          const Projection project(undistortion.camera(), pose);
          const cv::Mat depth = draw_depth(hull, project).depth;
          const cv::Mat in_both = (depth > 0) & undistortion.covered();
          cv::Mat is_object;
          cv::erode(in_both, is_object, element, {-1, -1}, 1, cv::BORDER_REFLECT);
          straight[v] = {luma_of(undistortion.image(views.views[v].image)),
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
