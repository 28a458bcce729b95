// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include <cmath>
#include <cstdint>

namespace sheen::fitting::billboard {

/// Holds the object.
struct Sphere {
  Eigen::Vector3f centre;  ///< object frame, metres
  float radius_m;          ///< > 0
};

/// A sphere around all triangles, its radius within one percent of the smallest one's.
Sphere bounding_sphere(const core::Mesh& mesh);

/// The camera of one frame. It looks at the centre of a sphere that just fits into its square
/// image; a billboard is that image on the plane through the centre. In its frame x points right, y
/// up and z towards the camera. With the distance b = r / sin(a) from the centre, a half the field
/// of view, that plane shows b tan(a) = r / cos(a) to either side; 1 / b = 0 is the orthographic
/// camera.
struct FrameCamera {
  Eigen::Vector3f centre;  ///< of the sphere, object frame, metres
  Eigen::Matrix3f axes;    ///< rows: right, up, towards the camera
  float radius_m;          ///< of the sphere
  float half_m;            ///< half a side of the image on the plane through the centre
  float inverse_distance;  ///< 1 / b, 1/m
  int side_px;

  [[nodiscard]] Eigen::Vector3f in_frame(const Eigen::Vector3f& in_object) const {
    return axes * (in_object - centre);
  }
  /// How much larger something is on the image than at the centre.
  [[nodiscard]] float magnification(float towards_m) const {
    return 1.0f / (1.0f - towards_m * inverse_distance);
  }
  /// Where the image shows a point of its frame, pixels; (0, 0) is the middle of the first one.
  [[nodiscard]] Eigen::Vector2f pixel(const Eigen::Vector3f& in_frame) const {
    const float half_px = 0.5f * static_cast<float>(side_px);
    const float px_per_m = half_px / half_m * magnification(in_frame.z());
    return {in_frame.x() * px_per_m + half_px - 0.5f, half_px - 0.5f - in_frame.y() * px_per_m};
  }
  /// A point in the direction in which the camera lies from `in_object`, object frame.
  [[nodiscard]] Eigen::Vector3f viewer_of(const Eigen::Vector3f& in_object) const {
    const Eigen::Vector3f towards = axes.row(2).transpose();
    if (inverse_distance > 0.0f) return centre + towards / inverse_distance;
    return in_object + towards;
  }
};

/// `direction`: from the centre towards the camera, unit vector. `field_of_view_deg` in [0, 180),
/// 0: orthographic.
FrameCamera frame_camera(const Sphere& sphere, const Eigen::Vector3f& direction,
                         double field_of_view_deg, int side_px);

/// What a frame shows of the object.
struct FrameImage {
  cv::Rect crop;  ///< of the camera's image, the object's bounding box; empty where nothing is seen
  cv::Mat colour;  ///< CV_8UC3 BGR; beside the object the nearest colour of the object
  /// CV_8UC3: coverage of the pixel, 0 to 255; depth code, beside the object that of the nearest
  /// pixel; 255 where something seen in the fit contributes.
  cv::Mat shape;
};

/// Depth codes: distance from the plane through the centre towards the camera.
inline std::uint8_t depth_code(float towards_m, float radius_m) {
  const float code = 127.5f * (1.0f + towards_m / radius_m);
  return static_cast<std::uint8_t>(std::lround(std::fmin(std::fmax(code, 0.0f), 255.0f)));
}
inline float towards_m(float code, float radius_m) {
  return radius_m * (code / 127.5f - 1.0f);
}

}  // namespace sheen::fitting::billboard
