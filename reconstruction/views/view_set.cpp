// SPDX-License-Identifier: MIT
#include "reconstruction/views/view_set.h"

#include "core/concurrency/parallel_for.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <limits>

namespace sheen::reconstruction {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kFlattestSine = 0.035F;  // of the angle between a ray and the plane, two degrees

cv::Mat rays_of(const core::CameraModel& camera, int threads) {
  cv::Mat rays(camera.height_px(), camera.width_px(), CV_32FC2);
  core::parallel_for(
      static_cast<std::size_t>(rays.rows), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
          auto* row = rays.ptr<cv::Vec2f>(static_cast<int>(y));
          for (int x = 0; x < rays.cols; ++x) {
            const auto ray = camera.unproject({x, static_cast<double>(y)});
            row[x] = ray ? cv::Vec2f(static_cast<float>(ray->x()), static_cast<float>(ray->y()))
                         : cv::Vec2f(kNaN, kNaN);
          }
        }
      },
      8);
  return rays;
}

}  // namespace

ViewSet make_view_set(const core::CameraModel& camera, const std::vector<PosedImage>& images,
                      int threads) {
  ViewSet set;
  set.camera = camera;
  set.rays = rays_of(camera, threads);
  for (const PosedImage& posed : images) {
    set.views.push_back({posed.frame_index, posed.image, posed.camera_from_board,
                         Projection(camera, posed.camera_from_board)});
  }
  return set;
}

int reduction(int width_px, int widest_px) {
  return (width_px + widest_px - 1) / widest_px;
}

cv::Mat reduced(const cv::Mat& image, int factor) {
  if (factor == 1) return image;
  const cv::Size size(image.cols / factor, image.rows / factor);
  cv::Mat means;
  cv::resize(image(cv::Rect(0, 0, size.width * factor, size.height * factor)), means, size, 0, 0,
             cv::INTER_AREA);
  return means;
}

core::CameraModel reduced(const core::CameraModel& camera, int factor) {
  core::CameraModel::Intrinsics intrinsics = camera.intrinsics();
  intrinsics.width_px /= factor;
  intrinsics.height_px /= factor;
  intrinsics.focal_px /= factor;
  // Centres of blocks lie half a pixel beside those of their first pixels.
  intrinsics.principal_px = ((intrinsics.principal_px.array() + 0.5) / factor - 0.5).matrix();
  return core::CameraModel(intrinsics);
}

ViewSet reduced(const ViewSet& views, std::size_t most, int widest_px, int threads) {
  const int factor = reduction(views.camera.width_px(), widest_px);
  const std::size_t count = std::min(most, views.views.size());
  std::vector<PosedImage> images(count);
  core::parallel_for(
      count, threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const View& view = views.views[(2 * i + 1) * views.views.size() / (2 * count)];
          images[i] = {view.frame_index, reduced(view.image, factor), view.camera_from_board};
        }
      },
      1);
  if (factor == 1) {
    ViewSet some;
    some.camera = views.camera;
    some.rays = views.rays;
    for (const PosedImage& posed : images) {
      some.views.push_back({posed.frame_index, posed.image, posed.camera_from_board,
                            Projection(views.camera, posed.camera_from_board)});
    }
    return some;
  }
  return make_view_set(reduced(views.camera, factor), images, threads);
}

cv::Mat plane_points(const ViewSet& views, const View& view) {
  cv::Mat points(views.rays.size(), CV_32FC2);
  const Eigen::Vector3f eye = view.project.eye();
  for (int y = 0; y < points.rows; ++y) {
    const auto* rays = views.rays.ptr<cv::Vec2f>(y);
    auto* row = points.ptr<cv::Vec2f>(y);
    for (int x = 0; x < points.cols; ++x) {
      const Eigen::Vector3f d = view.project.direction(rays[x][0], rays[x][1]);
      if (!(d.z() < -kFlattestSine * d.norm())) {
        row[x] = {kNaN, kNaN};
        continue;
      }
      const float way = -eye.z() / d.z();
      row[x] = {eye.x() + way * d.x(), eye.y() + way * d.y()};
    }
  }
  return points;
}

}  // namespace sheen::reconstruction
