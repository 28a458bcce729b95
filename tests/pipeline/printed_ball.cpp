// SPDX-License-Identifier: MIT
#include "tests/pipeline/printed_ball.h"

#include <cmath>
#include <numbers>

namespace sheen::pipeline::test {
namespace {

double luma_at(const Eigen::Vector3d& p) {
  constexpr double k = 2 * std::numbers::pi / 0.008;
  return 0.5 + 0.15 * (std::sin(k * p.x() + 1) + std::sin(k * p.y() + 2) + std::sin(k * p.z()));
}

double gloss_at(const Eigen::Vector3d& p, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d halfway = (Eigen::Vector3d(0.3, 0.2, 0.9).normalized() - ray).normalized();
  return 0.4 * std::pow(std::max(0.0, halfway.dot(p) / kBallRadius_m), 40);
}

}  // namespace

core::Mesh ball() {
  constexpr int rings = 24, steps = 36;
  core::Mesh mesh;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int step = 0; step < steps; ++step) {
      const double polar = std::numbers::pi * (ring + 0.5) / (rings + 1);
      const double turn = 2 * std::numbers::pi * step / steps;
      const Eigen::Vector3f normal(static_cast<float>(std::sin(polar) * std::cos(turn)),
                                   static_cast<float>(std::sin(polar) * std::sin(turn)),
                                   static_cast<float>(std::cos(polar)));
      mesh.positions.push_back(static_cast<float>(kBallRadius_m) * normal);
      mesh.normals.push_back(normal);
      if (ring == rings) continue;
      const auto here = static_cast<std::uint32_t>(ring * steps + step);
      const auto next = static_cast<std::uint32_t>(ring * steps + (step + 1) % steps);
      mesh.triangles.push_back({here, here + steps, next});
      mesh.triangles.push_back({next, here + steps, next + steps});
    }
  }
  return mesh;
}

cv::Mat photograph(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                   const BallPhotograph& how) {
  constexpr double radius2 = kBallRadius_m * kBallRadius_m;
  const Eigen::Isometry3d object_from_camera = camera_from_object.inverse();
  const Eigen::Vector3d to_middle = how.middle_m - object_from_camera.translation();
  cv::Mat image(camera.height_px(), camera.width_px(), CV_8UC3, how.background);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const Eigen::Vector3d ray =
          (object_from_camera.linear() * *camera.unproject({x, y})).normalized();
      const double along = ray.dot(to_middle);
      const double off2 = to_middle.squaredNorm() - along * along;
      double luma = 0.5;
      if (off2 <= radius2) {
        const Eigen::Vector3d p = (along - std::sqrt(radius2 - off2)) * ray - to_middle;
        luma = std::min(1.0, luma_at(p) + (how.is_glossy ? gloss_at(p, ray) : 0));
      } else if (off2 > radius2 * (1 + how.halo) * (1 + how.halo)) {
        continue;
      }
      image.at<cv::Vec3b>(y, x) = cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(255 * luma));
    }
  }
  return image;
}

}  // namespace sheen::pipeline::test
