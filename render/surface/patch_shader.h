// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "core/mesh/mesh.h"
#include "fitting/patch_light_field.h"
#include "render/gl/functions.h"

#include <Eigen/Core>
#include <opencv2/core/types.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace sheen::render {

/// Texture unit of a texture over the surface; the others are the patches'.
inline constexpr GLuint kSurfaceTextureUnit = 7;

/// What one representation adds to the common renderer: its coefficients on the GPU and the GLSL
/// that reads them. All members need the context current.
class PatchShader {
 public:
  virtual ~PatchShader() = default;

  /// GLSL that defines `vec4 evaluate_patch(int patch_idx, vec2 uv)`: colour sum and weight sum of
  /// a patch, as LightField::evaluate.
  [[nodiscard]] virtual std::string glsl() const = 0;

  /// Whether `glsl` defines `vec3 between_patches(int triangle_idx, vec3 place, vec3 n)`, too: what
  /// is added at a place of the surface (object frame) with the unit normal n. May change with
  /// `upload`.
  [[nodiscard]] virtual bool adds_between_patches() const { return false; }

  /// Layout of a texture that is added to what patches interpolate to; null: none. With one,
  /// `bind` makes it available as kSurfaceTextureUnit.
  [[nodiscard]] virtual const core::Atlas* atlas() const { return nullptr; }

  /// With an atlas: GLSL of the fragment stage that defines `vec3 surface_texture(vec2 place)`, the
  /// colour added at a place in parts of the atlas' sides. By default it is read from
  /// kSurfaceTextureUnit.
  [[nodiscard]] virtual std::string texture_glsl() const;

  /// Sends these elements of the light field (ascending, no repeats), neighbouring ones together.
  /// Returns the bytes handed to OpenGL.
  virtual std::size_t upload(std::span<const std::uint32_t> elements) = 0;

  /// Called before every draw with the eye in the object frame (metres) and the size of the image,
  /// for shaders that depend on the view on this side of OpenGL. May draw elsewhere.
  virtual void look_from(const Eigen::Vector3f& /*eye*/, const cv::Size& /*image_px*/) {}

  /// Makes the coefficients available to the next draw.
  virtual void bind() const = 0;
};

/// The shader of the light field's representation, all patches uploaded. `gl` and `light_field`
/// must outlive it. Throws core::Error (run_failed) when the representation cannot be drawn, or is
/// too large for the driver.
std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl,
                                               const fitting::PatchLightField& light_field);

/// The same, and for a representation without a shader of its own one that shows what the CPU
/// evaluates for each view on `threads` threads (render/evaluated). `mesh` must outlive it too:
/// its vertices are the patches.
std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl, const core::Mesh& mesh,
                                               const fitting::PatchLightField& light_field,
                                               int threads);

/// Whether the representation has a shader of its own, which reads the light field in `upload`
/// only.
bool has_patch_shader(const fitting::PatchLightField& light_field);

/// The shader class of one representation, made from its model.
template <typename Shader, typename Model>
std::unique_ptr<PatchShader> make_shader_of(const gl::Functions& gl,
                                            const fitting::PatchLightField& light_field) {
  return std::make_unique<Shader>(gl, dynamic_cast<const Model&>(light_field));
}

}  // namespace sheen::render
