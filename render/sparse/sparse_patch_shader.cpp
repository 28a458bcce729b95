// SPDX-License-Identifier: MIT
#include "render/sparse/sparse_patch_shader.h"

#include "fitting/sparse/light_field_model.h"
#include "render/shaders/shader_text.h"
#include "render/sparse/patch_terms.h"

#include <string>
#include <vector>

namespace sheen::render::sparse {
namespace {

using fitting::sparse::LightFieldModel;

// Centre and reciprocal support of every atom, one RGBA32F texel each.
std::vector<float> atom_table() {
  std::vector<float> table;
  for (const fitting::sparse::Atom& atom : fitting::sparse::atoms()) {
    table.insert(table.end(), {atom.center.x(), atom.center.y(), 1.0f / atom.support, 0.0f});
  }
  return table;
}

class SparsePatchShader final : public PatchShader {
 public:
  SparsePatchShader(const gl::Functions& gl, const LightFieldModel& model)
      : gl_(gl), patch_count_(model.patch_count()), terms_(gl, model) {
    const std::vector<float> table = atom_table();
    atom_buffer_ = gl::make_buffer(gl_, static_cast<GLsizeiptr>(table.size() * sizeof(table[0])),
                                   table.data());
    atom_texture_ = gl::make_texture(gl_, GL_TEXTURE_BUFFER);
    gl_.TextureBuffer(atom_texture_.name(), GL_RGBA32F, atom_buffer_.name());
  }

  [[nodiscard]] std::string glsl() const override {
    return "#define PATCH_COUNT " + std::to_string(patch_count_) + "\n" +
           std::string(shader_text("sparse/sparse.glsl"));
  }

  std::size_t upload(std::span<const std::uint32_t> patches) override {
    return terms_.upload(patches);
  }

  void bind() const override {
    terms_.bind(0);
    gl_.BindTextureUnit(1, atom_texture_.name());
  }

 private:
  const gl::Functions& gl_;
  std::size_t patch_count_;
  PatchTerms terms_;
  gl::Buffer atom_buffer_;
  gl::Texture atom_texture_;
};

}  // namespace

std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl,
                                               const fitting::PatchLightField& light_field) {
  return make_shader_of<SparsePatchShader, LightFieldModel>(gl, light_field);
}

}  // namespace sheen::render::sparse
