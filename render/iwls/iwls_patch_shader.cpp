// SPDX-License-Identifier: MIT
#include "render/iwls/iwls_patch_shader.h"

#include "fitting/iwls/light_field_model.h"
#include "render/shaders/shader_text.h"
#include "render/surface/patch_buffer.h"

#include <algorithm>
#include <cassert>
#include <iomanip>
#include <limits>
#include <locale>
#include <span>
#include <sstream>

namespace sheen::render::iwls {
namespace {

using fitting::iwls::LightFieldModel;

void write_list(std::ostream& text, std::span<const float> slots, const char* name) {
  text << "const vec4 " << name << "[QUADS] = vec4[QUADS](";
  for (std::size_t i = 0; i < slots.size(); i += 4) {
    text << (i == 0 ? "vec4(" : ", vec4(") << slots[i] << ", " << slots[i + 1] << ", "
         << slots[i + 2] << ", " << slots[i + 3] << ")";
  }
  text << ");\n";
}

/// The model's coefficients as they lie in memory, four centres to a texel, behind one texel with
/// the weight of the patch.
class IwlsPatchShader final : public PatchShader {
 public:
  IwlsPatchShader(const gl::Functions& gl, const LightFieldModel& model)
      : model_(model), buffer_(gl, model.patch_count(), 1 + model.coefficients_per_patch() / 4) {
    upload(all_patches(model.patch_count()));
  }

  [[nodiscard]] std::string glsl() const override {
    // Write the model's shape as constants, so that the driver can unroll and fold.
    const fitting::iwls::ModelShape& shape = model_.shape();
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << std::scientific << std::setprecision(std::numeric_limits<float>::max_digits10);
    text << "#define QUADS " << model_.slots_u().size() / 4 << "\n#define TERMS " << shape.terms
         << "\n#define INVERSE_SUPPORT " << 1.0f / shape.support_radius << "\n";
    write_list(text, model_.slots_u(), "centre_u");
    write_list(text, model_.slots_v(), "centre_v");
    text << shader_text("iwls/iwls.glsl");
    return text.str();
  }

  std::size_t upload(std::span<const std::uint32_t> patches) override {
    return buffer_.upload(patches, [this](std::size_t patch_idx, std::span<Eigen::half> texels) {
      const bool observed = model_.observed()[patch_idx] != 0;
      std::ranges::fill(texels.first(4), Eigen::half(observed ? 1.0f : fitting::kUnseenWeight));
      std::ranges::copy(model_.coefficients(patch_idx), texels.subspan(4).begin());
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
  return make_shader_of<IwlsPatchShader, LightFieldModel>(gl, light_field);
}

}  // namespace sheen::render::iwls
