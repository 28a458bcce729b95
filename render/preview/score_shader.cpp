// SPDX-License-Identifier: MIT
#include "render/preview/score_shader.h"

#include "render/shaders/shader_text.h"
#include "render/surface/patch_buffer.h"

#include <algorithm>

namespace sheen::render {
namespace {

std::string definition(const char* name, const Eigen::Vector3f& colour) {
  return "#define " + std::string(name) + " vec3(" + std::to_string(colour.x()) + ", " +
         std::to_string(colour.y()) + ", " + std::to_string(colour.z()) + ")\n";
}

class ScoreShader final : public PatchShader {
 public:
  ScoreShader(const gl::Functions& gl, const std::vector<float>& scores,
              const ScorePalette& palette)
      : scores_(scores), palette_(palette), buffer_(gl, scores.size(), 1) {
    upload(all_patches(scores.size()));
  }

  [[nodiscard]] std::string glsl() const override {
    return definition("LOW", palette_.low) + definition("MIDDLE", palette_.middle) +
           definition("HIGH", palette_.high) + definition("UNSEEN", palette_.unseen) +
           std::string(shader_text("preview/score.glsl"));
  }

  std::size_t upload(std::span<const std::uint32_t> patches) override {
    return buffer_.upload(patches, [this](std::size_t patch_idx, std::span<Eigen::half> texel) {
      std::ranges::fill(texel, Eigen::half(scores_[patch_idx]));
    });
  }

  void bind() const override { buffer_.bind(0); }

 private:
  const std::vector<float>& scores_;
  ScorePalette palette_;
  PatchBuffer buffer_;
};

}  // namespace

std::unique_ptr<PatchShader> make_score_shader(const gl::Functions& gl,
                                               const std::vector<float>& scores,
                                               const ScorePalette& palette) {
  return std::make_unique<ScoreShader>(gl, scores, palette);
}

}  // namespace sheen::render
