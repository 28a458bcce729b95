// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>
#include <string_view>

namespace sheen::capture::synthetic {

/// How the object's enamel shines: not at all, in bands, everywhere; `textured` shines like `mixed`
/// under a fine print.
/// white: no colour, no gloss, no texture; only outlines tell its shape.
enum class SceneKind { matte, mixed, glossy, textured, white };

inline constexpr std::array<std::string_view, 5> kSceneNames{"matte", "mixed", "glossy", "textured",
                                                             "white"};
std::optional<SceneKind> scene_kind(std::string_view name);

/// What a point of a surface does with light.
struct Brdf {
  Eigen::Vector3f albedo{0, 0, 0};  ///< diffuse reflectance, linear RGB in [0, 1]
  float specular = 0;               ///< reflectance at normal incidence; 0 = Lambert only
  float alpha = 0.3f;               ///< GGX width (roughness squared), (0, 1]
};

/// Enamel bands under fine marbling, a function of the place in the object frame (metres).
/// `unit_m` scales the pattern: half the width of a band.
Brdf brdf_at(SceneKind kind, const Eigen::Vector3f& point_in_object, float unit_m);

/// Smooth noise in [-1, 1] with features of size 1 (gradients on the integer lattice).
float smooth_noise(const Eigen::Vector3f& point);

}  // namespace sheen::capture::synthetic
