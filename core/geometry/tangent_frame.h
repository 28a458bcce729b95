// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

namespace sheen::core {

/// Orthonormal frame of a patch in the object frame; (tangent, bitangent, normal) is right-handed.
struct TangentFrame {
  Eigen::Vector3f tangent;
  Eigen::Vector3f bitangent;
  Eigen::Vector3f normal;

  /// A direction given by its components in the frame, object frame.
  [[nodiscard]] Eigen::Vector3f in_object(const Eigen::Vector3f& local) const {
    return local.x() * tangent + local.y() * bitangent + local.z() * normal;
  }
};

/// The one frame that every part of the program derives from a unit normal: no seam except where
/// n.z changes sign, no normalisation. Duff et al., "Building an Orthonormal Basis, Revisited"
/// (2017).
inline TangentFrame tangent_frame(const Eigen::Vector3f& n) {
  const float sign = std::copysign(1.0f, n.z());
  const float a = -1.0f / (sign + n.z());
  const float b = n.x() * n.y() * a;
  return {{1.0f + sign * n.x() * n.x() * a, sign * b, -sign * n.x()},
          {b, sign + n.y() * n.y() * a, -n.y()},
          n};
}

/// View direction of a patch on the unit disc (orthographic projection of the hemisphere, eq. 3).
struct DiscDirection {
  Eigen::Vector2f uv;  ///< (w . tangent, w . bitangent)
  float cosine;        ///< w . normal; negative when the patch is seen from behind
};

/// Direction from `position` towards `eye` (both in the object frame, metres).
inline DiscDirection direction_towards(const TangentFrame& frame, const Eigen::Vector3f& position,
                                       const Eigen::Vector3f& eye) {
  const Eigen::Vector3f w = (eye - position).normalized();
  return {{w.dot(frame.tangent), w.dot(frame.bitangent)}, w.dot(frame.normal)};
}

}  // namespace sheen::core
