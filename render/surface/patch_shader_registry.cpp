// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "render/detail/detail_patch_shader.h"
#include "render/evaluated/evaluated_patch_shader.h"
#include "render/iwls/iwls_patch_shader.h"
#include "render/mean/mean_patch_shader.h"
#include "render/shaders/shader_text.h"
#include "render/sparse/sparse_patch_shader.h"
#include "render/spherical_harmonics/harmonics_patch_shader.h"
#include "render/surface/patch_shader.h"

#include <string>
#include <string_view>
#include <utility>

namespace sheen::render {
namespace {

using Factory = std::unique_ptr<PatchShader> (*)(const gl::Functions&,
                                                 const fitting::PatchLightField&);

/// One line per representation.
constexpr std::pair<std::string_view, Factory> kPatchShaders[] = {
    {"detail", detail::make_patch_shader}, {"iwls", iwls::make_patch_shader},
    {"mean", mean::make_patch_shader},     {"sh", spherical_harmonics::make_patch_shader},
    {"sparse", sparse::make_patch_shader},
};

// Null when there is none.
Factory factory_of(const fitting::PatchLightField& light_field) {
  for (const auto& [name, make] : kPatchShaders) {
    if (name == light_field.representation()) return make;
  }
  return nullptr;
}

}  // namespace

std::string PatchShader::texture_glsl() const {
  return std::string(shader_text("shaders/surface_texture.glsl"));
}

bool has_patch_shader(const fitting::PatchLightField& light_field) {
  return factory_of(light_field) != nullptr;
}

std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl,
                                               const fitting::PatchLightField& light_field) {
  if (const Factory make = factory_of(light_field)) return make(gl, light_field);
  throw core::Error(core::Error::Kind::run_failed,
                    "representation " + std::string(light_field.representation()),
                    "has no patch shader in this program", "use the reference renderer");
}

std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl, const core::Mesh& mesh,
                                               const fitting::PatchLightField& light_field,
                                               int threads) {
  if (const Factory make = factory_of(light_field)) return make(gl, light_field);
  return evaluated::make_patch_shader(gl, mesh, light_field, threads);
}

}  // namespace sheen::render
