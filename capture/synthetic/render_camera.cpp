// SPDX-License-Identifier: MIT
#include "capture/synthetic/render_camera.h"

#include "capture/synthetic/hash.h"
#include "core/concurrency/parallel_for.h"
#include "core/image/srgb_curve.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace sheen::capture::synthetic {
namespace {

/// Fractional part of a number that is not negative.
float fraction(float x) {
  return x - std::floor(x);
}

/// Two independent numbers of the standard normal distribution (Box and Muller).
Eigen::Vector2f normal_pair(std::uint32_t seed) {
  const float u = 1 - unit_float(hash(seed, 1U));
  const float angle = 2 * std::numbers::pi_v<float> * unit_float(hash(seed, 2U));
  const float radius = std::sqrt(-2 * std::log(u));
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// IEC 61966-2-1: linear [0, 1] -> 8-bit code.
std::uint8_t srgb_code(float linear) {
  const float code = core::srgb_from_linear(std::clamp(linear, 0.0f, 1.0f));
  return static_cast<std::uint8_t>(std::lround(255 * code));
}

}  // namespace

RenderCamera::RenderCamera(const core::CameraModel& camera)
    : width_px_(camera.width_px()), height_px_(camera.height_px()) {
  // Undo the lens once per pixel corner; inside a pixel it is straight to 1e-6 of a pixel.
  corners_.reserve(static_cast<std::size_t>(width_px_ + 1) *
                   static_cast<std::size_t>(height_px_ + 1));
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (int y = 0; y <= height_px_; ++y) {
    for (int x = 0; x <= width_px_; ++x) {
      const auto ideal = camera.unproject({x - 0.5, y - 0.5});
      corners_.push_back(ideal ? Eigen::Vector2f(ideal->head<2>().cast<float>())
                               : Eigen::Vector2f(nan, nan));
    }
  }
}

Eigen::Vector3f RenderCamera::ray(int x, int y, float fx, float fy) const {
  const Eigen::Vector2f* upper =
      &corners_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px_ + 1) +
                static_cast<std::size_t>(x)];
  const Eigen::Vector2f* lower = upper + width_px_ + 1;
  const Eigen::Vector2f ideal =
      (1 - fy) * ((1 - fx) * upper[0] + fx * upper[1]) + fy * ((1 - fx) * lower[0] + fx * lower[1]);
  return {ideal.x(), ideal.y(), 1};
}

Exposure RenderCamera::expose(const Scene& scene,
                              std::span<const Eigen::Isometry3d> board_from_camera, int samples,
                              std::uint32_t seed, int threads) const {
  assert(board_from_camera.size() == 1 ||
         board_from_camera.size() == static_cast<std::size_t>(height_px_));
  Exposure exposure{cv::Mat(height_px_, width_px_, CV_32FC3),
                    cv::Mat(height_px_, width_px_, CV_32FC1)};

  const auto expose_pixel = [&](int x, int y) {
    const Eigen::Isometry3d& pose =
        board_from_camera[board_from_camera.size() == 1 ? 0 : static_cast<std::size_t>(y)];
    const Eigen::Vector3f eye = pose.translation().cast<float>();
    const Eigen::Matrix3f board_from_axes = pose.linear().cast<float>();
    // Shift one low-discrepancy set (Roberts' R2) differently in every pixel.
    const std::uint32_t bits =
        hash(seed, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    const float shift_x = unit_float(bits);
    const float shift_y = unit_float(hash(bits));
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    int on_object = 0;
    for (int i = 0; i < samples; ++i) {
      const auto step = static_cast<float>(i);
      const Eigen::Vector3f direction =
          ray(x, y, fraction(shift_x + 0.75487767f * step), fraction(shift_y + 0.56984029f * step));
      if (!direction.allFinite()) continue;  // beyond the lens: black
      const Scene::Sight sight = scene.trace(eye, (board_from_axes * direction).normalized());
      sum += sight.value;
      on_object += sight.on_object ? 1 : 0;
    }
    const float share = 1 / static_cast<float>(samples);
    exposure.light.at<cv::Vec3f>(y, x) = {share * sum.x(), share * sum.y(), share * sum.z()};
    exposure.object.at<float>(y, x) = share * static_cast<float>(on_object);
  };

  const auto pixels = static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_);
  core::parallel_for(pixels, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      expose_pixel(static_cast<int>(i % static_cast<std::size_t>(width_px_)),
                   static_cast<int>(i / static_cast<std::size_t>(width_px_)));
    }
  });
  return exposure;
}

cv::Mat RenderCamera::depth_m(const Scene& scene, const Eigen::Isometry3d& board_from_camera,
                              int threads) const {
  const Eigen::Vector3f eye = board_from_camera.translation().cast<float>();
  const Eigen::Matrix3f board_from_axes = board_from_camera.linear().cast<float>();
  cv::Mat depth(height_px_, width_px_, CV_32FC1);
  core::parallel_for(
      static_cast<std::size_t>(height_px_), threads, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
          for (int x = 0; x < width_px_; ++x) {
            // The ray's z is 1, so that along it unit depth is its length.
            const Eigen::Vector3f direction = ray(x, y, 0.5f, 0.5f);
            const float length = direction.norm();
            depth.at<float>(y, x) =
                direction.allFinite()
                    ? scene.distance_m(eye, board_from_axes * direction / length) / length
                    : 0.0f;
          }
        }
      });
  return depth;
}

cv::Mat develop(const cv::Mat& light, const SensorNoise& noise, std::uint32_t seed) {
  cv::Mat image(light.size(), CV_8UC3);
  for (int y = 0; y < light.rows; ++y) {
    for (int x = 0; x < light.cols; ++x) {
      const cv::Vec3f& linear = light.at<cv::Vec3f>(y, x);
      const std::uint32_t place =
          hash(seed, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
      const Eigen::Vector2f first = normal_pair(hash(place, 3U));
      const Eigen::Vector2f second = normal_pair(hash(place, 4U));
      const Eigen::Vector3f unit(first.x(), first.y(), second.x());
      cv::Vec3b& bgr = image.at<cv::Vec3b>(y, x);
      for (int channel = 0; channel < 3; ++channel) {
        const float value = linear[channel];
        const float sigma = std::sqrt(noise.read * noise.read + noise.shot * std::max(value, 0.0f));
        bgr[2 - channel] = srgb_code(value + sigma * unit[channel]);
      }
    }
  }
  return image;
}

}  // namespace sheen::capture::synthetic
