// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/synthetic/brdf.h"
#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <memory>

namespace sheen::capture::synthetic {

/// An enamelled object on a board of tags under studio light. Radiance depends on the place and the
/// direction alone, so that a surface light field can hold all of it. May be traced from several
/// threads.
class Scene {
 public:
  /// Puts `object` (object frame, metres) on the board: centred by its bounding box, turned a
  /// little about z, its lowest point `lift_m` above the paper.
  Scene(SceneKind kind, core::Mesh object, float lift_m, int threads);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  [[nodiscard]] const core::Mesh& object() const;  ///< object frame
  [[nodiscard]] const Eigen::Isometry3d& board_from_object() const;
  [[nodiscard]] const Board& board() const;
  /// Radius of the object about its centre, and that centre in the board frame; metres.
  [[nodiscard]] double object_radius_m() const;
  [[nodiscard]] Eigen::Vector3d object_centre() const;

  struct Sight {
    Eigen::Vector3f value;  ///< exposed linear RGB, 1 = white, may exceed 1
    bool on_object = false;
  };
  /// What a ray sees; board frame, `direction` of unit length.
  [[nodiscard]] Sight trace(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;
  /// How far along it the ray meets object or board; 0 where it meets neither.
  [[nodiscard]] float distance_m(const Eigen::Vector3f& origin,
                                 const Eigen::Vector3f& direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::capture::synthetic
