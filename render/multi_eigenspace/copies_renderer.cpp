// SPDX-License-Identifier: MIT
#include "render/multi_eigenspace/copies_renderer.h"

#include "core/diagnostics/error.h"
#include "render/gl/instanced_strips.h"
#include "render/gl/offscreen_target.h"
#include "render/gl/program.h"
#include "render/shaders/shader_text.h"
#include "render/views/read_view.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace sheen::render {
namespace {

using fitting::multi_eigenspace::billboard_towards;
using fitting::multi_eigenspace::Eigenspace;
using fitting::multi_eigenspace::MultiEigenspace;
using fitting::multi_eigenspace::SpaceShare;

constexpr std::uint32_t kImage = std::uint32_t{1} << 31;
/// Depths are near / z; any length does that is shorter than what is drawn is away.
constexpr double kNearPart = 1e-3;

/// As the shaders have them.
struct CopyRecord {
  std::array<float, 4> middle, right, down;
  std::array<std::uint32_t, 4> terms;
};
struct TermRecord {
  std::uint32_t layer;
  float weight;
};
struct ViewRecord {
  std::array<float, 4> focal_principal, size_near;
};

std::array<float, 4> four(const Eigen::Vector3d& vector) {
  const Eigen::Vector3f single = vector.cast<float>();
  return {single.x(), single.y(), single.z(), 0};
}

class CopiesRenderer final : public Renderer {
 public:
  CopiesRenderer(Context& context, const MultiEigenspace& model,
                 std::vector<Eigen::Isometry3d> scene_from_objects)
      : context_(context),
        gl_(gl::load_functions(context)),
        model_(model),
        scene_from_objects_(std::move(scene_from_objects)),
        target_(gl_, gl::Colour::bytes) {
    const std::array<gl::ShaderStage, 2> stages{
        gl::ShaderStage{
            GL_VERTEX_SHADER, "copies.vert", {shader_text("multi_eigenspace/copies.vert")}},
        gl::ShaderStage{
            GL_FRAGMENT_SHADER, "copies.frag", {shader_text("multi_eigenspace/copies.frag")}}};
    program_ = gl::make_program(gl_, stages);
    no_attributes_ = gl::make_vertex_array(gl_);
    send_pictures();
  }

  /// The pictures are there from the beginning.
  std::size_t upload(std::span<const std::uint32_t> /*spaces*/) override { return 0; }

  RenderedView render(const core::CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_scene) override;

 private:
  [[nodiscard]] gl::Texture make_array(GLenum format, GLenum type,
                                       const std::vector<cv::Mat>& layers) const;
  void send_pictures();
  void add_terms(const std::vector<SpaceShare>& shares);
  void list_copies(const Eigen::Isometry3d& camera_from_scene);
  void draw_copies(const core::CameraModel& camera);

  Context& context_;
  gl::Functions gl_;
  const MultiEigenspace& model_;
  std::vector<Eigen::Isometry3d> scene_from_objects_;
  gl::OffscreenTarget target_;
  gl::Program program_;
  gl::VertexArray no_attributes_;
  gl::Texture means_, images_;
  std::vector<std::uint32_t> first_image_;  ///< layer of every space's first eigenimage
  std::vector<CopyRecord> copies_;
  std::vector<TermRecord> terms_;
};

/// All levels of detail: these are as linear as the sums.
gl::Texture CopiesRenderer::make_array(GLenum format, GLenum type,
                                       const std::vector<cv::Mat>& layers) const {
  const int side_px = model_.options().picture_px;
  // One layer at least, so that there is something to bind.
  const auto count = std::max<GLsizei>(1, static_cast<GLsizei>(layers.size()));
  gl::Texture texture = gl::make_texture(gl_, GL_TEXTURE_2D_ARRAY);
  int levels = 1;
  while (side_px >> levels > 0) ++levels;
  gl_.TextureStorage3D(texture.name(), levels, format, side_px, side_px, count);
  if (count > gl::integer_limit(gl_, GL_MAX_ARRAY_TEXTURE_LAYERS) ||
      gl_.GetError() == GL_OUT_OF_MEMORY) {
    throw core::Error(core::Error::Kind::run_failed, std::to_string(count) + " eigenimages",
                      "are more than this OpenGL driver holds",
                      "make the model with a larger --space-tolerance");
  }
  for (std::size_t i = 0; i < layers.size(); ++i) {
    gl_.TextureSubImage3D(texture.name(), 0, 0, 0, static_cast<GLint>(i), side_px, side_px, 1,
                          GL_BGRA, type, layers[i].data);
  }
  gl_.GenerateTextureMipmap(texture.name());
  gl_.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

void CopiesRenderer::send_pictures() {
  std::vector<cv::Mat> means, images;
  for (const Eigenspace& space : model_.spaces()) {
    means.push_back(space.mean);
    first_image_.push_back(static_cast<std::uint32_t>(images.size()));
    images.insert(images.end(), space.images.begin(), space.images.end());
  }
  means_ = make_array(GL_RGBA8, GL_UNSIGNED_BYTE, means);
  images_ = make_array(GL_RGBA8_SNORM, GL_BYTE, images);
}

void CopiesRenderer::add_terms(const std::vector<SpaceShare>& shares) {
  // What the texture gives as 1 is 127 steps of an eigenimage, and 255 grey levels of the sum.
  constexpr float whole = std::numeric_limits<std::int8_t>::max() / 255.0f;
  for (const auto& [space_idx, share, coefficients] : shares) {
    terms_.push_back({space_idx, share});
    const Eigenspace& space = model_.spaces()[space_idx];
    for (std::size_t k = 0; k < coefficients.size(); ++k) {
      terms_.push_back({kImage | (first_image_[space_idx] + static_cast<std::uint32_t>(k)),
                        share * coefficients[k] * space.steps[k] * whole});
    }
  }
}

void CopiesRenderer::list_copies(const Eigen::Isometry3d& camera_from_scene) {
  copies_.clear();
  terms_.clear();
  for (const Eigen::Isometry3d& scene_from_object : scene_from_objects_) {
    const Eigen::Isometry3d camera_from_object = camera_from_scene * scene_from_object;
    const auto board =
        billboard_towards(model_.frame(), camera_from_object.inverse().translation());
    const Eigen::Vector3d middle = camera_from_object * model_.frame().centre;
    if (!board || !(middle.z() > 0)) continue;
    const auto first = static_cast<std::uint32_t>(terms_.size());
    add_terms(model_.shares(board->towards_eye));
    const auto count = static_cast<std::uint32_t>(terms_.size()) - first;
    if (count == 0) continue;
    const auto side = [&](const Eigen::Vector3d& axis) {
      return four(board->half_side_m * (camera_from_object.linear() * axis));
    };
    copies_.push_back({four(middle), side(board->right), side(board->down), {first, count, 0, 0}});
  }
}

void CopiesRenderer::draw_copies(const core::CameraModel& camera) {
  const GLuint framebuffer = target_.framebuffer(camera.width_px(), camera.height_px());
  constexpr std::array<float, 4> nothing{0, 0, 0, 0};
  gl_.ClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, nothing.data());
  gl_.ClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, nothing.data());
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  if (copies_.empty()) return;

  const auto& in = camera.intrinsics();
  const auto single = [](double value) { return static_cast<float>(value); };
  const ViewRecord view{
      {single(in.focal_px.x()), single(in.focal_px.y()), single(in.principal_px.x()),
       single(in.principal_px.y())},
      {single(in.width_px), single(in.height_px), single(kNearPart * model_.frame().radius_m), 0}};
  const auto buffer = [&](const auto& records) {
    return gl::make_buffer(gl_, static_cast<GLsizeiptr>(records.size() * sizeof(records[0])),
                           records.data());
  };
  const gl::Buffer copies = buffer(copies_);
  const gl::Buffer terms = buffer(terms_);
  const gl::Buffer block = gl::make_buffer(gl_, sizeof(view), &view);
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, copies.name());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, terms.name());
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, block.name());
  gl_.BindTextureUnit(0, means_.name());
  gl_.BindTextureUnit(1, images_.name());

  gl::draw_instanced_strips(gl_, program_.name(), no_attributes_.name(),
                            {camera.width_px(), camera.height_px()},
                            static_cast<GLsizei>(copies_.size()));
}

RenderedView CopiesRenderer::render(const core::CameraModel& camera,
                                    const Eigen::Isometry3d& camera_from_scene) {
  context_.make_current();
  list_copies(camera_from_scene);
  draw_copies(camera);
  return read_view(gl_, {camera.width_px(), camera.height_px()});
}

}  // namespace

std::unique_ptr<Renderer> make_copies_renderer(Context& context, const MultiEigenspace& model,
                                               std::vector<Eigen::Isometry3d> scene_from_objects) {
  return std::make_unique<CopiesRenderer>(context, model, std::move(scene_from_objects));
}

}  // namespace sheen::render
