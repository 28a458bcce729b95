// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/vertex_view.h"
#include "core/visibility/raster_visibility.h"
#include "core/visibility/ray_caster.h"
#include "fitting/fitter.h"
#include "pipeline/view_observer.h"
#include "tests/render/test_scenes.h"

#include <opencv2/core.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace sheen::fitting::testing {

/// Colour of a point of the surface, sRGB in [0, 1], towards a viewer (unit vector).
using Look = std::function<Eigen::Vector3f(const Eigen::Vector3f& point,
                                           const Eigen::Vector3f& towards_viewer)>;

struct Photograph {
  cv::Mat image;
  Eigen::Isometry3d camera_from_object;
};

/// A mesh and photographs of it without noise, one ray per pixel.
class Photographs {
 public:
  Photographs(core::Mesh mesh, int views, const Look& look)
      : Photographs(std::move(mesh), poses_all_round(views), look) {}

  Photographs(core::Mesh mesh, const std::vector<Eigen::Isometry3d>& poses, const Look& look)
      : mesh_(std::move(mesh)), camera_(render::testing::plain_camera(160, 120)) {
    const core::RayCaster caster(mesh_);
    for (const Eigen::Isometry3d& pose : poses) views_.push_back(take(caster, pose, look));
  }

  [[nodiscard]] const core::Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const core::CameraModel& camera() const { return camera_; }
  [[nodiscard]] const std::vector<Photograph>& views() const { return views_; }

  /// Shows the fitter these views, in this order.
  void show(const std::vector<int>& order, Fitter& fitter) const {
    observe(order, [&](const core::Observation& observation) { fitter.integrate(observation); });
  }
  void observe(const std::vector<int>& order,
               const std::function<void(const core::Observation&)>& look) const {
    pipeline::ViewObserver observer(mesh_, core::make_raster_visibility(mesh_, 1), {}, 1);
    for (const int i : order) {
      const Photograph& view = views_[static_cast<std::size_t>(i)];
      look(observer.observe(i, view.image, camera_, view.camera_from_object));
    }
  }

 private:
  static std::vector<Eigen::Isometry3d> poses_all_round(int views) {
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < views; ++i) {
      const double angle = 2.4 * i;
      const Eigen::Vector3d from(std::cos(angle), std::sin(angle), 0.8 * std::sin(1.1 * i));
      poses.push_back(render::testing::looking_at_origin(from, 0.36));
    }
    return poses;
  }

  [[nodiscard]] Photograph take(const core::RayCaster& caster, const Eigen::Isometry3d& pose,
                                const Look& look) const {
    Photograph photograph{
        cv::Mat(camera_.height_px(), camera_.width_px(), CV_8UC3, cv::Scalar(0, 0, 0)), pose};
    const Eigen::Vector3f eye = core::eye_in_object(pose);
    const Eigen::Matrix3d object_from_camera = pose.linear().transpose();
    for (int y = 0; y < photograph.image.rows; ++y) {
      for (int x = 0; x < photograph.image.cols; ++x) {
        const auto ray = camera_.unproject({static_cast<double>(x), static_cast<double>(y)});
        const Eigen::Vector3f direction = (object_from_camera * *ray).cast<float>();
        const auto hit =
            caster.first_hit(eye, direction, 0, std::numeric_limits<float>::infinity());
        if (!hit) continue;
        const Eigen::Vector3f rgb =
            255.0f * look(eye + hit->distance * direction, -direction.normalized());
        for (int channel = 0; channel < 3; ++channel) {
          photograph.image.at<cv::Vec3b>(y, x)[channel] =
              cv::saturate_cast<std::uint8_t>(rgb[2 - channel]);
        }
      }
    }
    return photograph;
  }

  core::Mesh mesh_;
  core::CameraModel camera_;
  std::vector<Photograph> views_;
};

}  // namespace sheen::fitting::testing
