// SPDX-License-Identifier: MIT
#include "render/sparse/sparse_patch_shader.h"

#include "fitting/sparse/light_field_model.h"
#include "render/shaders/shader_text.h"
#include "render/surface/patch_buffer.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <vector>

namespace sheen::render::sparse {
namespace {

using fitting::sparse::kLinearBase;
using fitting::sparse::LightFieldModel;
using fitting::sparse::PatchModel;

// As sparse.glsl reads them; sums of them are exact in a half.
constexpr float kLinearFlag = 32.0f;
constexpr float kObservedFlag = 64.0f;
static_assert(fitting::kUnseenWeight == 1.0f / 1024.0f, "sparse.glsl says so too");

// Room grows in steps of this many texels, so that a growing model is not sent anew for each RBF.
constexpr std::size_t kTexelStep = 4;
constexpr std::size_t kMostTexels = kLinearBase + fitting::sparse::kMaxRbfs;

// Centre and reciprocal support of every atom, one RGBA32F texel each.
std::vector<float> atom_table() {
  std::vector<float> table;
  for (const fitting::sparse::Atom& atom : fitting::sparse::atoms()) {
    table.insert(table.end(), {atom.center.x(), atom.center.y(), 1.0f / atom.support, 0.0f});
  }
  return table;
}

void write_texels(const PatchModel& patch, bool observed, std::span<Eigen::half> texels) {
  for (std::size_t term = 0; term < patch.term_count(); ++term) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      texels[4 * term + channel] =
          Eigen::half(patch.coefficient[term][static_cast<Eigen::Index>(channel)]);
    }
    const bool is_rbf = term >= patch.base_terms;
    texels[4 * term + 3] =
        Eigen::half(is_rbf ? static_cast<float>(patch.atom[term - patch.base_terms]) : 0.0f);
  }
  texels[3] = Eigen::half(static_cast<float>(patch.rbf_count) +
                          (patch.base_terms == kLinearBase ? kLinearFlag : 0.0f) +
                          (observed ? kObservedFlag : 0.0f));
  std::ranges::fill(texels.subspan(4 * patch.term_count()), Eigen::half(0.0f));
}

/// One texel per term. All patches get as many texels as the largest one needs: one fetch finds a
/// patch, and a changed patch is sent to its own place.
class SparsePatchShader final : public PatchShader {
 public:
  SparsePatchShader(const gl::Functions& gl, const LightFieldModel& model)
      : gl_(gl), model_(model), all_(all_patches(model.patch_count())) {
    const std::vector<float> table = atom_table();
    atom_buffer_ = gl::make_buffer(gl_, static_cast<GLsizeiptr>(table.size() * sizeof(table[0])),
                                   table.data());
    atom_texture_ = gl::make_texture(gl_, GL_TEXTURE_BUFFER);
    gl_.TextureBuffer(atom_texture_.name(), GL_RGBA32F, atom_buffer_.name());
    upload(all_);
  }

  [[nodiscard]] std::string glsl() const override {
    return "#define PATCH_COUNT " + std::to_string(model_.patch_count()) + "\n" +
           std::string(shader_text("sparse/sparse.glsl"));
  }

  std::size_t upload(std::span<const std::uint32_t> patches) override {
    return send(make_room(patches) ? std::span<const std::uint32_t>(all_) : patches);
  }

  void bind() const override {
    buffer_->bind(0);
    gl_.BindTextureUnit(1, atom_texture_.name());
  }

 private:
  // Returns whether the buffer is a new one.
  bool make_room(std::span<const std::uint32_t> patches) {
    std::size_t needed = 1;
    for (const std::uint32_t patch : patches) {
      needed = std::max(needed, model_.term_count(patch));
    }
    if (needed <= texels_per_patch_) return false;
    // A matte model stays at one texel; a growing one gets a little ahead of its need.
    const std::size_t rounded = (needed + kTexelStep - 1) / kTexelStep * kTexelStep;
    const std::size_t texels = needed == 1 ? 1 : std::min(rounded, kMostTexels);
    buffer_ = std::make_unique<PatchBuffer>(gl_, model_.patch_count(), texels);
    texels_per_patch_ = texels;
    return true;
  }

  std::size_t send(std::span<const std::uint32_t> patches) {
    return buffer_->upload(patches, [this](std::size_t patch_idx, std::span<Eigen::half> texels) {
      write_texels(model_.patch(patch_idx), model_.observed()[patch_idx] != 0, texels);
    });
  }

  const gl::Functions& gl_;
  const LightFieldModel& model_;
  std::vector<std::uint32_t> all_;
  std::size_t texels_per_patch_ = 0;
  std::unique_ptr<PatchBuffer> buffer_;
  gl::Buffer atom_buffer_;
  gl::Texture atom_texture_;
};

}  // namespace

std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl,
                                               const fitting::PatchLightField& light_field) {
  return make_shader_of<SparsePatchShader, LightFieldModel>(gl, light_field);
}

}  // namespace sheen::render::sparse
