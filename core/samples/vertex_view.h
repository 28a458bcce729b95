// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/geometry/tangent_frame.h"
#include "core/mesh/mesh.h"
#include "core/samples/surface_points.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sheen::core {

/// Why a vertex gives no sample in a view; `none` means it does (so far).
enum class VertexRejection : std::uint8_t { none, outside_image, back_facing, grazing, occluded };
inline constexpr std::size_t kVertexRejectionCount = 5;
std::string_view name_of(VertexRejection rejection);

/// Which vertices may become samples.
struct SamplingLimits {
  float min_cosine = 0.2f;  ///< grazing cut-off: smallest cosine between normal and view, [0, 1)
  float border_margin_px = 2.0f;  ///< samples nearer to the image's border are refused, >= 1;
                                  ///< counted from the centres of the outermost pixels
};

/// All vertices of a mesh seen by one camera. Structure of arrays, one entry per vertex. Pixels
/// hold wherever `depth_m` > 0, outside the image too; directions where the vertex is not
/// rejected.
struct VertexView {
  std::vector<float> x_px, y_px;  ///< pixel, OpenCV's convention, lens distortion included
  std::vector<float> depth_m;     ///< z in the camera frame; 0 behind the camera and beyond the
                                  ///< lens model
  std::vector<float> u, v;        ///< view direction on the patch's unit disc
  std::vector<VertexRejection> rejection;
};

/// Frames of all vertices of a mesh, in order. A vertex that no triangle uses is not part of the
/// surface: its three vectors are zero, so every view direction has cosine 0 there and it never
/// gives a sample.
std::vector<TangentFrame> tangent_frames(const Mesh& mesh);

/// Position of the camera in the object frame.
Eigen::Vector3f eye_in_object(const Eigen::Isometry3d& camera_from_object);

/// Projects every vertex and applies the limits that need no other vertex (all but `occluded`). The
/// first that fails is noted: behind the camera, beyond the lens model or outside the image less
/// its margin (outside_image), cosine <= 0 (back_facing), cosine < min_cosine (grazing). Reuses the
/// storage of `view`. Single precision; the same bits on any number of threads and on every
/// processor.
void project_vertices(const SurfacePoints& points, const CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_object, const SamplingLimits& limits,
                      int threads, VertexView& view);

/// Counts of each VertexRejection, indexed by its value.
std::array<std::size_t, kVertexRejectionCount> count_rejections(const VertexView& view);

}  // namespace sheen::core
