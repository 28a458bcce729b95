// SPDX-License-Identifier: MIT
#include "render/surface/surface_pass.h"

#include "core/atlas/atlas_vertices.h"
#include "core/mesh/bounds.h"
#include "fitting/patch_light_field.h"
#include "render/gl/program.h"
#include "render/shaders/shader_text.h"
#include "render/surface/view_block.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <utility>
#include <vector>

namespace sheen::render {
namespace {

struct Vertex {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
};
static_assert(sizeof(Vertex) == 6 * sizeof(float));

/// With a texture a vertex may be there several times, once for each of its places.
struct TexturedVertex {
  Vertex vertex;
  core::AtlasPoint place;
  std::uint32_t patch_idx;
};
static_assert(sizeof(TexturedVertex) == sizeof(Vertex) + 2 * sizeof(std::uint32_t));

constexpr GLuint kCornerUnit = 4, kVertexUnit = 5;  // as in surface.vert

gl::Program make_surface_program(const gl::Functions& gl, const std::string& patch_glsl,
                                 bool adds_between, const std::string& texture_glsl,
                                 bool tessellated) {
  // Say in front of every stage what is wanted.
  const bool shaded = !patch_glsl.empty();
  const std::string defines =
      std::string(shaded ? "#define SHADED\n" : "") +
      (texture_glsl.empty() ? "" : "#define TEXTURED\n") +
      (adds_between ? "#define BETWEEN\n" : "") + (tessellated ? "#define TESSELLATED\n" : "") +
      "#define UNSEEN_WEIGHT " + std::to_string(fitting::kUnseenWeight) + "\n";
  const std::string lens = lens_glsl();
  const std::string between =
      adds_between ? lens + std::string(shader_text("shaders/direction.glsl")) + patch_glsl : "";

  // Gather the stages.
  std::vector<gl::ShaderStage> stages;
  stages.push_back({GL_VERTEX_SHADER,
                    "surface.vert",
                    {defines, lens, shader_text("shaders/direction.glsl"), patch_glsl,
                     shader_text("shaders/surface.vert")}});
  if (tessellated) {
    stages.push_back({GL_TESS_CONTROL_SHADER,
                      "surface.tesc",
                      {defines, lens, shader_text("shaders/surface.tesc")}});
    stages.push_back({GL_TESS_EVALUATION_SHADER,
                      "surface.tese",
                      {defines, lens, shader_text("shaders/surface.tese")}});
  }
  const char* const fragment = shaded ? "shaders/surface.frag" : "shaders/depth.frag";
  stages.push_back(
      {GL_FRAGMENT_SHADER, fragment, {defines, between, texture_glsl, shader_text(fragment)}});
  return gl::make_program(gl, stages);
}

}  // namespace

SurfacePass::SurfacePass(const gl::Functions& gl, const core::Mesh& mesh) : gl_(gl) {
  measure(mesh);
  upload(mesh);
  program(false);
}

SurfacePass::SurfacePass(const gl::Functions& gl, const core::Mesh& mesh, const PatchShader& paint)
    : gl_(gl), patch_glsl_(paint.glsl()), adds_between_(paint.adds_between_patches()) {
  measure(mesh);
  if (const core::Atlas* const atlas = paint.atlas()) {
    texture_glsl_ = paint.texture_glsl();
    upload_split(mesh, *atlas);
  } else {
    upload(mesh);
  }
  program(false);
}

void SurfacePass::set_adds_between(bool adds_between) {
  if (adds_between == adds_between_) return;
  adds_between_ = adds_between;
  plain_ = {};
  tessellated_ = {};
}

void SurfacePass::draw(GLuint target, const core::CameraModel& camera,
                       const Eigen::Isometry3d& camera_from_object) {
  // Tell the shaders about the view.
  const double longest_segment = longest_straight_segment(camera);
  const bool tessellated = needs_tessellation(camera_from_object, longest_segment);
  const gl::Program& chosen = program(tessellated);
  const ViewBlock block =
      make_view_block(camera, camera_from_object, static_cast<double>(near_m_), longest_segment);
  gl_.NamedBufferSubData(view_block_.name(), 0, sizeof(block), &block);
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, view_block_.name());

  // Clear: black, transparent, infinitely far.
  set_state(camera);
  constexpr std::array<float, 4> nothing{0, 0, 0, 0};
  if (!patch_glsl_.empty()) gl_.ClearNamedFramebufferfv(target, GL_COLOR, 0, nothing.data());
  gl_.ClearNamedFramebufferfv(target, GL_DEPTH, 0, nothing.data());

  // Draw.
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
  gl_.UseProgram(chosen.name());
  gl_.BindVertexArray(vertex_array_.name());
  gl_.PatchParameteri(GL_PATCH_VERTICES, 3);
  if (tessellated && adds_between_) {
    bind_vertices_to_look_up();
    gl_.DrawArraysInstanced(GL_PATCHES, 0, index_count_, 1);
  } else {
    gl_.DrawElements(tessellated ? GL_PATCHES : GL_TRIANGLES, index_count_, GL_UNSIGNED_INT,
                     nullptr);
  }
  gl_.BindVertexArray(0);
  gl_.ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

void SurfacePass::measure(const core::Mesh& mesh) {
  assert(!mesh.positions.empty() && mesh.normals.size() == mesh.positions.size());
  const Eigen::AlignedBox3f box = core::bounds_of(mesh);
  float radius = 0;
  for (const Eigen::Vector3f& position : mesh.positions) {
    radius = std::max(radius, (position - box.center()).norm());
  }
  float longest = 0;
  for (const auto& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3f edge =
          mesh.positions[triangle[(corner + 1) % 3]] - mesh.positions[triangle[corner]];
      longest = std::max(longest, edge.norm());
    }
  }
  centre_ = box.center().cast<double>();
  radius_m_ = static_cast<double>(radius);
  longest_edge_m_ = static_cast<double>(longest);
  near_m_ = std::max(1e-3f * radius, std::numeric_limits<float>::min());
}

void SurfacePass::upload(const core::Mesh& mesh) {
  std::vector<Vertex> vertices(mesh.positions.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] = {mesh.positions[i], mesh.normals[i]};
  }
  make_buffers(vertices, mesh.triangles);
}

void SurfacePass::upload_split(const core::Mesh& mesh, const core::Atlas& atlas) {
  const core::AtlasVertices split = core::split_at_seams(mesh, atlas);
  std::vector<TexturedVertex> vertices(split.vertex.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::uint32_t vertex = split.vertex[i];
    vertices[i] = {{mesh.positions[vertex], mesh.normals[vertex]}, split.place[i], vertex};
  }
  make_buffers(vertices, split.triangles);
  const GLuint array = vertex_array_.name();
  for (const GLuint attribute : {2u, 3u}) {
    gl_.EnableVertexArrayAttrib(array, attribute);
    gl_.VertexArrayAttribBinding(array, attribute, 0);
  }
  gl_.VertexArrayAttribFormat(array, 2, 2, GL_UNSIGNED_SHORT, GL_TRUE, sizeof(Vertex));
  gl_.VertexArrayAttribIFormat(array, 3, 1, GL_UNSIGNED_INT,
                               sizeof(Vertex) + sizeof(core::AtlasPoint));
}

/// Position and normal are what every vertex begins with.
template <typename Vertex>
void SurfacePass::make_buffers(const std::vector<Vertex>& vertices,
                               const decltype(core::Mesh::triangles)& triangles) {
  // Fill the buffers.
  index_count_ = static_cast<GLsizei>(3 * triangles.size());
  vertices_ = gl::make_buffer(gl_, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
                              vertices.data());
  indices_ = gl::make_buffer(gl_, static_cast<GLsizeiptr>(triangles.size() * sizeof(triangles[0])),
                             triangles.data());
  view_block_ = gl::make_buffer(gl_, sizeof(ViewBlock), nullptr);

  // Say how a vertex lies in them.
  vertex_array_ = gl::make_vertex_array(gl_);
  const GLuint array = vertex_array_.name();
  gl_.VertexArrayVertexBuffer(array, 0, vertices_.name(), 0, sizeof(Vertex));
  gl_.VertexArrayElementBuffer(array, indices_.name());
  for (const GLuint attribute : {0u, 1u}) {
    gl_.EnableVertexArrayAttrib(array, attribute);
    gl_.VertexArrayAttribFormat(array, attribute, 3, GL_FLOAT, GL_FALSE,
                                attribute * sizeof(Eigen::Vector3f));
    gl_.VertexArrayAttribBinding(array, attribute, 0);
  }
}

/// Made at first need.
void SurfacePass::bind_vertices_to_look_up() {
  assert(!texture_glsl_.empty());
  if (corner_texture_.name() == 0) {
    corner_texture_ = gl::make_texture(gl_, GL_TEXTURE_BUFFER);
    gl_.TextureBuffer(corner_texture_.name(), GL_R32UI, indices_.name());
    vertex_texture_ = gl::make_texture(gl_, GL_TEXTURE_BUFFER);
    gl_.TextureBuffer(vertex_texture_.name(), GL_RGBA32UI, vertices_.name());
  }
  gl_.BindTextureUnit(kCornerUnit, corner_texture_.name());
  gl_.BindTextureUnit(kVertexUnit, vertex_texture_.name());
}

void SurfacePass::set_state(const core::CameraModel& camera) const {
  gl_.Viewport(0, 0, camera.width_px(), camera.height_px());
  // Upper left: row 0 of what is read back is the image's first row.
  gl_.ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_GREATER);
  gl_.DepthMask(GL_TRUE);
  gl_.Enable(GL_CULL_FACE);
  gl_.CullFace(GL_BACK);
  gl_.FrontFace(GL_CCW);
  gl_.Disable(GL_BLEND);
  gl_.Disable(GL_SCISSOR_TEST);
}

bool SurfacePass::needs_tessellation(const Eigen::Isometry3d& camera_from_object,
                                     double longest_segment) const {
  const double nearest_m =
      std::max((camera_from_object * centre_).z() - radius_m_, static_cast<double>(near_m_));
  return longest_edge_m_ / nearest_m > longest_segment;
}

const gl::Program& SurfacePass::program(bool tessellated) {
  gl::Program& program = tessellated ? tessellated_ : plain_;
  if (program.name() == 0) {
    program = make_surface_program(gl_, patch_glsl_, adds_between_, texture_glsl_, tessellated);
  }
  return program;
}

}  // namespace sheen::render
