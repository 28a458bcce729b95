// SPDX-License-Identifier: MIT
#include "render/spherical_harmonics/harmonics_patch_shader.h"

#include "fitting/spherical_harmonics/light_field_model.h"
#include "render/shaders/shader_text.h"
#include "render/surface/patch_buffer.h"

#include <cassert>
#include <string>

namespace sheen::render::spherical_harmonics {
namespace {

using fitting::spherical_harmonics::LightFieldModel;
using fitting::spherical_harmonics::term_count;

/// One texel per term: r, g, b, and in the patch's first texel the weight.
class HarmonicsPatchShader final : public PatchShader {
 public:
  HarmonicsPatchShader(const gl::Functions& gl, const LightFieldModel& model)
      : model_(model), buffer_(gl, model.patch_count(), term_count(model.degree())) {
    upload(all_patches(model.patch_count()));
  }

  [[nodiscard]] std::string glsl() const override {
    return "#define TERMS " + std::to_string(term_count(model_.degree())) + "\n" +
           std::string(shader_text("spherical_harmonics/harmonics.glsl"));
  }

  std::size_t upload(std::span<const std::uint32_t> patches) override {
    return buffer_.upload(patches, [this](std::size_t patch_idx, std::span<Eigen::half> texels) {
      write_colours(model_.coefficients(patch_idx), model_.observed()[patch_idx] != 0, texels);
    });
  }

  void bind() const override { buffer_.bind(0); }

 private:
  const LightFieldModel& model_;
  PatchBuffer buffer_;
};

}  // namespace

std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl,
                                               const fitting::PatchLightField& light_field) {
  return make_shader_of<HarmonicsPatchShader, LightFieldModel>(gl, light_field);
}

}  // namespace sheen::render::spherical_harmonics
