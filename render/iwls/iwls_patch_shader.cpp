// SPDX-License-Identifier: MIT
#include "render/iwls/iwls_patch_shader.h"

#include "fitting/iwls/light_field_model.h"
#include "render/shaders/shader_text.h"
#include "render/surface/patch_buffer.h"

#include <cassert>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>

namespace sheen::render::iwls {
namespace {

using fitting::iwls::LightFieldModel;

/// One texel per centre and term: r, g, b, and in the patch's first texel the weight.
class IwlsPatchShader final : public PatchShader {
 public:
  IwlsPatchShader(const gl::Functions& gl, const LightFieldModel& model)
      : model_(model), buffer_(gl, model.patch_count(), model.coefficients_per_patch() / 3) {
    upload(all_patches(model.patch_count()));
  }

  [[nodiscard]] std::string glsl() const override {
    // Write the model's shape as constants, so that the driver can unroll and fold.
    const fitting::iwls::ModelShape& shape = model_.shape();
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << std::scientific << std::setprecision(std::numeric_limits<float>::max_digits10);
    text << "#define CENTRES " << shape.centers.size() << "\n#define TERMS " << shape.terms
         << "\n#define SUPPORT " << shape.support_radius
         << "\nconst vec2 centre_positions[CENTRES] = vec2[CENTRES](";
    const char* separator = "";
    for (const Eigen::Vector2f& centre : shape.centers) {
      text << separator << "vec2(" << centre.x() << ", " << centre.y() << ")";
      separator = ", ";
    }
    text << ");\n" << shader_text("iwls/iwls.glsl");
    return text.str();
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
                                               const fitting::LightField& light_field) {
  const auto* const model = dynamic_cast<const LightFieldModel*>(&light_field);
  assert(model != nullptr);
  return std::make_unique<IwlsPatchShader>(gl, *model);
}

}  // namespace sheen::render::iwls
