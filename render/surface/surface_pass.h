// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"
#include "render/gl/owners.h"
#include "render/surface/patch_shader.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace sheen::render {

/// A mesh on the GPU, drawn as a camera with a lens sees it into the framebuffer that is bound:
/// front faces only, nearest first, depth values near / depth (1 at the near plane, 0 at infinity).
/// Where the lens would bend an edge visibly the triangles are tessellated first.
class SurfacePass {
 public:
  /// Depth only. The context is current; `gl` outlives the pass. Throws core::Error (run_failed).
  SurfacePass(const gl::Functions& gl, const core::Mesh& mesh);
  /// Colours, too: what `paint` (used here only) says of patches and of a texture.
  SurfacePass(const gl::Functions& gl, const core::Mesh& mesh, const PatchShader& paint);

  /// Whether `paint` adds between patches by now; fragments cost half as much again where it does.
  void set_adds_between(bool adds_between);

  /// Clears the bound framebuffer `target` and draws.
  void draw(GLuint target, const core::CameraModel& camera,
            const Eigen::Isometry3d& camera_from_object);

  /// Depth of the near plane, metres: a thousandth of the mesh's radius, which the reversed depth
  /// can afford.
  [[nodiscard]] float near_m() const { return near_m_; }

 private:
  void measure(const core::Mesh& mesh);
  void upload(const core::Mesh& mesh);
  void upload_split(const core::Mesh& mesh, const core::Atlas& atlas);
  template <typename Vertex>
  void make_buffers(const std::vector<Vertex>& vertices,
                    const decltype(core::Mesh::triangles)& triangles);
  void bind_vertices_to_look_up();
  void set_state(const core::CameraModel& camera) const;
  [[nodiscard]] bool needs_tessellation(const Eigen::Isometry3d& camera_from_object,
                                        double longest_segment) const;
  const gl::Program& program(bool tessellated);

  const gl::Functions& gl_;
  std::string patch_glsl_;                            ///< empty: depth only
  bool adds_between_ = false;                         ///< patch_glsl_ speaks of fragments, too
  std::string texture_glsl_;                          ///< empty: no texture
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  ///< of the bounds, object frame
  double radius_m_ = 0;
  double longest_edge_m_ = 0;
  float near_m_ = 0;
  GLsizei index_count_ = 0;
  gl::Buffer vertices_;
  gl::Buffer indices_;
  gl::Buffer view_block_;
  gl::VertexArray vertex_array_;
  gl::Texture corner_texture_, vertex_texture_;  ///< the same buffers
  gl::Program plain_;
  gl::Program tessellated_;  ///< made at first need
};

}  // namespace sheen::render
