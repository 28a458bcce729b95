// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <Eigen/Geometry>
#include <imgui.h>

#include <optional>
#include <vector>

namespace sheen::app {

/// Lines in the object's frame over an image that a camera without distortion has drawn at
/// `origin` in the window.
class Overlay {
 public:
  Overlay(ImDrawList& list, const ImVec2& origin, const ImVec2& scale,
          const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object);

  /// A pyramid from the eye towards the image, `depth_m` long; its base has the image's shape.
  void frustum(const core::CameraModel& lens, const Eigen::Isometry3d& lens_from_object,
               double depth_m, ImU32 colour, float thickness) const;
  void path(const std::vector<Eigen::Vector3d>& places, ImU32 colour, float thickness) const;
  void dot(const Eigen::Vector3d& place_in_object, float radius, ImU32 colour) const;
  /// A path with a head at its end.
  void arrow(const std::vector<Eigen::Vector3d>& places, ImU32 colour, float thickness) const;

 private:
  [[nodiscard]] std::optional<ImVec2> place(const Eigen::Vector3d& point_in_object) const;
  void line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, ImU32 colour,
            float thickness) const;

  ImDrawList& list_;
  ImVec2 origin_, scale_;
  const core::CameraModel& camera_;
  Eigen::Isometry3d camera_from_object_;
};

/// The shorter arc about `centre` from one place to another, its radius changing evenly.
std::vector<Eigen::Vector3d> arc_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                         const Eigen::Vector3d& centre);

/// Camera that stands at `eye` and looks at `centre`, upright.
Eigen::Isometry3d looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& centre,
                             const Eigen::Vector3d& up);

}  // namespace sheen::app
