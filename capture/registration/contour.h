// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"
#include "core/visibility/ray_caster.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace sheen::capture {

/// A place where the object ends in an image: against the background or against a farther part of
/// itself.
struct ContourPoint {
  Eigen::Vector3d in_object;  ///< on the surface, metres
  Eigen::Vector2d pixel;      ///< its image
  Eigen::Vector2d outward;    ///< unit vector in the image, out of the nearer surface
};

/// Finds silhouette and depth edges of a mesh: edges between a face turned to the camera and one
/// turned away, or without a second face, that a ray confirms as visible and as a step in depth.
class ContourFinder {
 public:
  /// `mesh` must outlive the finder.
  explicit ContourFinder(const core::Mesh& mesh);

  /// Points about `spacing_px` apart along the visible contours within the image.
  [[nodiscard]] std::vector<ContourPoint> find(const core::CameraModel& camera,
                                               const Eigen::Isometry3d& camera_from_object,
                                               double spacing_px) const;

  /// Whether a ray from the camera, in its frame, meets the object.
  [[nodiscard]] bool meets(const Eigen::Isometry3d& object_from_camera,
                           const Eigen::Vector3d& ray) const;

  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }

 private:
  static constexpr std::uint32_t kNoFace = ~std::uint32_t{0};
  struct Face {
    Eigen::Vector3f normal;  ///< unit
    Eigen::Vector3f centre;
  };
  struct Edge {
    std::array<std::uint32_t, 2> vertices;
    std::array<std::uint32_t, 2> faces{kNoFace, kNoFace};
    bool is_sharp = false;
  };

  /// A contour edge as one view has it.
  struct EdgeImage {
    Eigen::Vector3d begin, end;  ///< object frame
    Eigen::Vector3d normal;      ///< of the surface, not of unit length
    Eigen::Vector2d across;      ///< unit vector in the image, away from the nearer face
    double length_px = 0;
  };

  [[nodiscard]] std::vector<bool> faces_turned_to(const Eigen::Vector3f& eye) const;
  /// Nothing for an edge that is no contour from here or lies behind the camera.
  [[nodiscard]] std::optional<EdgeImage> image_of(
      const Edge& edge, const std::vector<bool>& turned_to_eye, const core::CameraModel& camera,
      const Eigen::Isometry3d& camera_from_object) const;

  /// Distance along the ray through a pixel to the surface, in units of depth; infinite: none.
  [[nodiscard]] double depth_at(const core::CameraModel& camera,
                                const Eigen::Isometry3d& object_from_camera,
                                const Eigen::Vector2d& pixel) const;
  [[nodiscard]] bool is_depth_step(const core::CameraModel& camera,
                                   const Eigen::Isometry3d& object_from_camera,
                                   const ContourPoint& point, double depth_m) const;

  const core::Mesh& mesh_;
  core::RayCaster rays_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  Eigen::AlignedBox3d bounds_;
  double radius_m_ = 0;
};

}  // namespace sheen::capture
