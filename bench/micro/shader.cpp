// SPDX-License-Identifier: MIT
// Drawing a light field against drawing plain vertex colours, in one context, 1024x768.
#include "bench/micro/walk.h"
#include "core/samples/vertex_view.h"
#include "fitting/eigen_texture/eigen_texture.h"
#include "fitting/iwls/center_layout.h"
#include "fitting/iwls/light_field_model.h"
#include "fitting/mean/mean_light_field.h"
#include "fitting/sparse/light_field_model.h"
#include "fitting/spherical_harmonics/light_field_model.h"
#include "render/eigen_texture/eigen_paint.h"
#include "render/evaluated/evaluated_patch_shader.h"
#include "render/gl/offscreen_target.h"
#include "render/gl/program.h"
#include "render/surface/patch_shader.h"
#include "render/surface/surface_pass.h"
#include "render/surface/view_block.h"

#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <random>
#include <vector>

namespace sheen {
namespace {

constexpr int kVertices = 31000;

// The walk's poses, seen by a camera of the size wanted, without distortion.
core::CameraModel camera() {
  core::CameraModel::Intrinsics intrinsics = bench::walk_round(kVertices).camera.intrinsics();
  intrinsics.focal_px *= 1024.0 / intrinsics.width_px;
  intrinsics.width_px = 1024;
  intrinsics.height_px = 768;
  intrinsics.principal_px = {511.5, 383.5};
  intrinsics.distortion = {};
  return core::CameraModel(intrinsics);
}

// The context that all share, and where they draw.
struct Stage {
  std::unique_ptr<render::Context> context = render::make_context();
  render::gl::Functions gl = render::gl::load_functions(*context);
  render::gl::OffscreenTarget target{gl, render::gl::Colour::bytes};

  // Waits until everything is drawn.
  void finish() const {
    std::array<std::uint8_t, 4> pixel;
    gl.ReadPixels(0, 0, 1, 1, GL_BGRA, GL_UNSIGNED_BYTE, pixel.data());
    benchmark::DoNotOptimize(pixel);
  }
};

Stage& stage() {
  static Stage the_stage;
  return the_stage;
}

// The floor: position and colour, nothing to evaluate.
class PlainColours {
 public:
  explicit PlainColours(const core::Mesh& mesh) : gl_(stage().gl) {
    std::vector<std::array<float, 6>> vertices;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const auto& p = mesh.positions[i];
      const auto& n = mesh.normals[i];
      vertices.push_back({p.x(), p.y(), p.z(), 0.5f + 0.5f * n.x(), 0.5f, 0.5f + 0.5f * n.z()});
    }
    vertices_ = render::gl::make_buffer(
        gl_, static_cast<GLsizeiptr>(vertices.size() * sizeof(vertices[0])), vertices.data());
    indices_ = render::gl::make_buffer(
        gl_, static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(mesh.triangles[0])),
        mesh.triangles.data());
    index_count_ = static_cast<GLsizei>(3 * mesh.triangles.size());
    view_ = render::gl::make_buffer(gl_, sizeof(render::ViewBlock), nullptr);
    array_ = render::gl::make_vertex_array(gl_);
    gl_.VertexArrayVertexBuffer(array_.name(), 0, vertices_.name(), 0, sizeof(vertices[0]));
    gl_.VertexArrayElementBuffer(array_.name(), indices_.name());
    for (const GLuint attribute : {0u, 1u}) {
      gl_.EnableVertexArrayAttrib(array_.name(), attribute);
      gl_.VertexArrayAttribFormat(array_.name(), attribute, 3, GL_FLOAT, GL_FALSE, 12 * attribute);
      gl_.VertexArrayAttribBinding(array_.name(), attribute, 0);
    }
    const std::string lens = render::lens_glsl();
    const std::array<render::gl::ShaderStage, 2> stages{
        render::gl::ShaderStage{GL_VERTEX_SHADER, "plain.vert", {lens, kVertex}},
        render::gl::ShaderStage{GL_FRAGMENT_SHADER, "plain.frag", {kFragment}}};
    program_ = render::gl::make_program(gl_, stages);
  }

  void draw(GLuint target, const core::CameraModel& camera, const Eigen::Isometry3d& pose) {
    const auto block = render::make_view_block(camera, pose, 1e-4, 1e9);
    gl_.NamedBufferSubData(view_.name(), 0, sizeof(block), &block);
    gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, view_.name());
    gl_.Viewport(0, 0, camera.width_px(), camera.height_px());
    gl_.ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_GREATER);
    gl_.Enable(GL_CULL_FACE);
    constexpr std::array<float, 4> nothing{0, 0, 0, 0};
    gl_.ClearNamedFramebufferfv(target, GL_COLOR, 0, nothing.data());
    gl_.ClearNamedFramebufferfv(target, GL_DEPTH, 0, nothing.data());
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.UseProgram(program_.name());
    gl_.BindVertexArray(array_.name());
    gl_.DrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  }

 private:
  static constexpr const char* kVertex =
      "layout(location = 0) in vec3 position;\nlayout(location = 1) in vec3 colour;\n"
      "layout(location = 0) out vec3 corner;\nvoid main() {\n  corner = colour;\n"
      "  gl_Position = clip_from_camera((camera_from_object * vec4(position, 1.0)).xyz);\n}\n";
  static constexpr const char* kFragment =
      "layout(location = 0) in vec3 corner;\nlayout(location = 0) out vec4 colour;\n"
      "void main() { colour = vec4(corner, 1.0); }\n";

  const render::gl::Functions& gl_;
  GLsizei index_count_ = 0;
  render::gl::Buffer vertices_, indices_, view_;
  render::gl::VertexArray array_;
  render::gl::Program program_;
};

void plain_vertex_colours(benchmark::State& state) {
  const bench::Walk& walk = bench::walk_round(kVertices);
  const core::CameraModel eye = camera();
  PlainColours plain(walk.mesh);
  std::size_t view = 0;
  for (auto _ : state) {
    const GLuint target = stage().target.framebuffer(eye.width_px(), eye.height_px());
    plain.draw(target, eye, walk.camera_from_object[view++ % walk.camera_from_object.size()]);
    stage().finish();
  }
}

// How a light field is drawn: by the shader of its fitter, or evaluated on the CPU.
void draw(benchmark::State& state, const fitting::PatchLightField& model, bool on_cpu = false) {
  const bench::Walk& walk = bench::walk_round(kVertices);
  const core::CameraModel eye = camera();
  const auto patches = on_cpu
                           ? render::evaluated::make_patch_shader(stage().gl, walk.mesh, model, 1)
                           : render::make_patch_shader(stage().gl, model);
  render::SurfacePass pass(stage().gl, walk.mesh, *patches);
  std::size_t view = 0;
  for (auto _ : state) {
    const auto& pose = walk.camera_from_object[view++ % walk.camera_from_object.size()];
    const GLuint target = stage().target.framebuffer(eye.width_px(), eye.height_px());
    patches->look_from(core::eye_in_object(pose), {eye.width_px(), eye.height_px()});
    patches->bind();
    pass.draw(target, eye, pose);
    stage().finish();
  }
}

std::size_t patch_count() {
  return bench::walk_round(kVertices).mesh.positions.size();
}

// Values do not change what the dense models cost: all patches are the same.
fitting::iwls::LightFieldModel iwls_model(int centers) {
  const auto layout = fitting::iwls::make_center_layout({}, centers);
  const auto radius = static_cast<float>(fitting::iwls::level_radius(layout.side));
  fitting::iwls::LightFieldModel model({layout.layout, layout.centers, 3, radius}, patch_count());
  for (std::size_t i = 0; i < patch_count(); ++i) model.store_observed(i, true);
  return model;
}

// Twenty luma bases of about 256 x 256 texels, summed at the texels.
void eigen_texture(benchmark::State& state) {
  constexpr std::size_t bases = 20, side = 256;
  const bench::Walk& walk = bench::walk_round(kVertices);
  fitting::eigen_texture::EigenTexture model(walk.mesh,
                                             core::make_atlas(walk.mesh, 5e-4f, side * side));
  std::mt19937 random(1);
  const std::vector<Eigen::Vector3f> directions{Eigen::Vector3f::UnitZ()};
  fitting::eigen_texture::Channel luma{bases, std::vector<std::int8_t>(bases * model.used().size()),
                                       std::vector<Eigen::half>(bases, Eigen::half(0.1f))};
  for (auto& one : luma.texels) one = static_cast<std::int8_t>(random() % 255 - 127);
  model.set_bases({std::move(luma), {}, {}}, directions);
  const auto paint = render::eigen_texture::make_eigen_paint(stage().gl, model);
  for (auto _ : state) {
    paint->look_from(Eigen::Vector3f::UnitZ(), {1024, 768});
    stage().finish();
  }
  state.SetItemsProcessed(state.iterations() *
                          static_cast<std::int64_t>(bases * model.mean().atlas().texel_count()));
}

void mean(benchmark::State& state) {
  draw(state, fitting::mean::MeanLightField(patch_count()));
}

void harmonics(benchmark::State& state) {
  draw(state, fitting::spherical_harmonics::LightFieldModel(3, patch_count()));
}

void quadtree(benchmark::State& state) {
  draw(state, iwls_model(static_cast<int>(state.range(0))));
}

void quadtree_on_cpu(benchmark::State& state) {
  draw(state, iwls_model(static_cast<int>(state.range(0))), true);
}

// As the study's scene ends up: 70 % of the patches one colour, 30 % with a linear base and,
// mostly, a few RBFs.
void sparse(benchmark::State& state) {
  std::mt19937 random(1);
  fitting::sparse::LightFieldModel model(patch_count());
  for (std::size_t i = 0; i < patch_count(); ++i) {
    fitting::sparse::PatchModel patch;
    if (random() % 10 < 3) {
      patch.base_terms = fitting::sparse::kLinearBase;
      patch.rbf_count = random() % 8;
      for (std::size_t k = 0; k < patch.rbf_count; ++k) {
        patch.atom[k] = static_cast<std::uint16_t>(30 * k + random() % 30);
      }
    }
    patch.coefficient.fill(Eigen::Vector3f::Constant(0.1f));
    model.store(i, patch);
    model.store_observed(i, true);
  }
  draw(state, model);
}

// llvmpipe has threads of its own: the time of the whole process counts.
#define SHEEN_DRAWING(...) \
  BENCHMARK(__VA_ARGS__)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond)

SHEEN_DRAWING(plain_vertex_colours);
SHEEN_DRAWING(mean);
SHEEN_DRAWING(harmonics);
SHEEN_DRAWING(sparse);
SHEEN_DRAWING(quadtree)->Arg(16)->Arg(64);
SHEEN_DRAWING(eigen_texture);
SHEEN_DRAWING(quadtree_on_cpu)->Arg(16)->Arg(64);

}  // namespace
}  // namespace sheen
