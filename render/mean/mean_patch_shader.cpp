// SPDX-License-Identifier: MIT
#include "render/mean/mean_patch_shader.h"

#include "fitting/mean/mean_light_field.h"
#include "render/shaders/shader_text.h"
#include "render/surface/patch_buffer.h"

#include <cassert>

namespace sheen::render::mean {
namespace {

using fitting::mean::MeanLightField;

/// One texel per patch: r, g, b, weight.
class MeanPatchShader final : public PatchShader {
 public:
  MeanPatchShader(const gl::Functions& gl, const MeanLightField& light_field)
      : light_field_(light_field), buffer_(gl, light_field.patch_count(), 1) {
    upload(all_patches(light_field.patch_count()));
  }

  [[nodiscard]] std::string glsl() const override {
    return std::string(shader_text("mean/mean.glsl"));
  }

  std::size_t upload(std::span<const std::uint32_t> patches) override {
    return buffer_.upload(patches, [this](std::size_t patch_idx, std::span<Eigen::half> texel) {
      write_colours(light_field_.coefficients().subspan(3 * patch_idx, 3),
                    light_field_.observed()[patch_idx] != 0, texel);
    });
  }

  void bind() const override { buffer_.bind(0); }

 private:
  const MeanLightField& light_field_;
  PatchBuffer buffer_;
};

}  // namespace

std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl,
                                               const fitting::PatchLightField& light_field) {
  return make_shader_of<MeanPatchShader, MeanLightField>(gl, light_field);
}

}  // namespace sheen::render::mean
