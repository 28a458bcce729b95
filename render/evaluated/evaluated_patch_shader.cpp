// SPDX-License-Identifier: MIT
#include "render/evaluated/evaluated_patch_shader.h"

#include "core/concurrency/parallel_for.h"
#include "core/geometry/tangent_frame.h"
#include "fitting/half.h"
#include "render/shaders/shader_text.h"
#include "render/surface/patch_buffer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <string>
#include <vector>

namespace sheen::render::evaluated {
namespace {

Eigen::half half(float value) {
  return fitting::stored_half(static_cast<double>(value));
}

/// One texel per patch: colour sum, weight sum. Half floats are within 2^-11 of the quotient.
class EvaluatedPatchShader final : public PatchShader {
 public:
  EvaluatedPatchShader(const gl::Functions& gl, const core::Mesh& mesh,
                       const fitting::PatchLightField& light_field, int threads)
      : mesh_(mesh),
        light_field_(light_field),
        threads_(threads),
        all_(all_patches(light_field.patch_count())),
        texels_(light_field.patch_count()),
        buffer_(gl, light_field.patch_count(), 1) {
    assert(mesh.positions.size() == light_field.patch_count());
  }

  [[nodiscard]] std::string glsl() const override {
    return std::string(shader_text("evaluated/evaluated.glsl"));
  }

  std::size_t upload(std::span<const std::uint32_t> patches) override {
    if (!patches.empty()) eye_.reset();
    return 0;
  }

  void look_from(const Eigen::Vector3f& eye, const cv::Size& /*image_px*/) override {
    // Nothing moved and nothing changed: the buffer still holds.
    if (eye_ && *eye_ == eye) return;
    core::parallel_for(texels_.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) texels_[i] = texel(i, eye);
    });
    buffer_.upload(all_, [this](std::size_t patch_idx, std::span<Eigen::half> halfs) {
      std::ranges::copy(texels_[patch_idx], halfs.begin());
    });
    eye_ = eye;
  }

  void bind() const override { buffer_.bind(0); }

 private:
  [[nodiscard]] std::array<Eigen::half, 4> texel(std::size_t patch_idx,
                                                 const Eigen::Vector3f& eye) const {
    const core::TangentFrame frame = core::tangent_frame(mesh_.normals[patch_idx]);
    const Eigen::Vector2f uv = core::direction_towards(frame, mesh_.positions[patch_idx], eye).uv;
    const fitting::WeightedColour sum = light_field_.evaluate(patch_idx, uv);
    return {half(sum.colour_sum.x()), half(sum.colour_sum.y()), half(sum.colour_sum.z()),
            half(sum.weight_sum)};
  }

  const core::Mesh& mesh_;
  const fitting::PatchLightField& light_field_;
  int threads_;
  std::vector<std::uint32_t> all_;
  std::vector<std::array<Eigen::half, 4>> texels_;
  PatchBuffer buffer_;
  std::optional<Eigen::Vector3f> eye_;  // that the buffer was filled for
};

}  // namespace

std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl, const core::Mesh& mesh,
                                               const fitting::PatchLightField& light_field,
                                               int threads) {
  return std::make_unique<EvaluatedPatchShader>(gl, mesh, light_field, threads);
}

}  // namespace sheen::render::evaluated
