// SPDX-License-Identifier: MIT
#include "render/preview/clay_shader.h"

#include "render/shaders/shader_text.h"

namespace sheen::render {
namespace {

class ClayShader final : public PatchShader {
 public:
  [[nodiscard]] std::string glsl() const override {
    return std::string(shader_text("preview/clay.glsl"));
  }
  std::size_t upload(std::span<const std::uint32_t> /*patches*/) override { return 0; }
  void bind() const override {}
};

}  // namespace

std::unique_ptr<PatchShader> make_clay_shader() {
  return std::make_unique<ClayShader>();
}

}  // namespace sheen::render
