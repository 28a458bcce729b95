// SPDX-License-Identifier: MIT
#include "render/eigen_texture/eigen_paint.h"

#include "render/eigen_texture/basis_layers.h"
#include "render/gl/offscreen_target.h"
#include "render/gl/program.h"
#include "render/shaders/shader_text.h"
#include "render/surface/patch_buffer.h"

#include <array>
#include <optional>
#include <string>

namespace sheen::render::eigen_texture {
namespace {

using fitting::eigen_texture::EigenTexture;

/// Draws into a texture of the atlas' size.
class TexelPass {
 public:
  explicit TexelPass(const gl::Functions& gl)
      : gl_(gl), no_attributes_(gl::make_vertex_array(gl)), target_(gl, gl::Colour::bytes) {
    const std::array<gl::ShaderStage, 2> stages{
        gl::ShaderStage{
            GL_VERTEX_SHADER, "everywhere.vert", {shader_text("shaders/everywhere.vert")}},
        gl::ShaderStage{GL_FRAGMENT_SHADER,
                        "at_texels.frag",
                        {shader_text("eigen_texture/layers.glsl"),
                         shader_text("eigen_texture/at_texels.frag")}}};
    program_ = gl::make_program(gl_, stages);
  }

  /// The layers are bound.
  void draw(const core::Atlas& atlas) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target_.framebuffer(atlas.width, atlas.height));
    gl_.Viewport(0, 0, atlas.width, atlas.height);
    for (const GLenum off : {GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND, GL_SCISSOR_TEST}) {
      gl_.Disable(off);
    }
    gl_.UseProgram(program_.name());
    gl_.BindVertexArray(no_attributes_.name());
    gl_.DrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);
    gl_.BindVertexArray(0);
  }

  void bind(GLuint unit) const { gl_.BindTextureUnit(unit, target_.colour_texture()); }

 private:
  const gl::Functions& gl_;
  gl::Program program_;
  gl::VertexArray no_attributes_;
  gl::OffscreenTarget target_;
};

class EigenPaint final : public PatchShader {
 public:
  EigenPaint(const gl::Functions& gl, const EigenTexture& model)
      : gl_(gl),
        model_(model),
        seen_(gl, model.vertex_means().patch_count(), 1),
        vertices_(all_patches(model.vertex_means().patch_count())),
        texels_(gl) {
    take_over();
  }

  /// Patches add nothing; they say only what was seen.
  [[nodiscard]] std::string glsl() const override {
    return std::string(shader_text("mean/mean.glsl"));
  }
  [[nodiscard]] const core::Atlas* atlas() const override { return &model_.mean().atlas(); }
  [[nodiscard]] std::string texture_glsl() const override {
    return std::string(shader_text("eigen_texture/layers.glsl")) +
           std::string(shader_text("eigen_texture/at_pixels.glsl"));
  }

  std::size_t upload(std::span<const std::uint32_t> elements) override {
    return elements.empty() ? 0 : take_over();
  }

  void look_from(const Eigen::Vector3f& eye, const cv::Size& image_px) override {
    layers_->look_from(eye);
    in_texture_space_ = static_cast<std::size_t>(image_px.area()) >= model_.used().size();
    if (!in_texture_space_) return;
    layers_->bind();
    texels_.draw(*atlas());
  }

  void bind() const override {
    seen_.bind(0);
    if (in_texture_space_) {
      layers_->bind_no_layers();
      texels_.bind(kSurfaceTextureUnit);
    } else {
      layers_->bind();
    }
  }

 private:
  std::size_t take_over() {
    layers_.emplace(gl_, model_);
    const std::array<Eigen::half, 3> nothing{};
    return layers_->byte_size() +
           seen_.upload(vertices_, [&](std::size_t vertex_idx, std::span<Eigen::half> texel) {
             write_colours(nothing, model_.vertex_means().observed()[vertex_idx] != 0, texel);
           });
  }

  const gl::Functions& gl_;
  const EigenTexture& model_;
  PatchBuffer seen_;
  std::vector<std::uint32_t> vertices_;
  std::optional<BasisLayers> layers_;  ///< of the light field as uploaded
  TexelPass texels_;
  bool in_texture_space_ = false;
};

}  // namespace

std::unique_ptr<PatchShader> make_eigen_paint(const gl::Functions& gl,
                                              const EigenTexture& light_field) {
  return std::make_unique<EigenPaint>(gl, light_field);
}

}  // namespace sheen::render::eigen_texture
