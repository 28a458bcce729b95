// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/study/random.h"

#include <Eigen/Core>

#include <array>
#include <string_view>

namespace sheen::evaluation {

/// The nine classes of reflectance that the study draws its points from.
enum class MaterialClass {
  lambert,
  ggx60,
  ggx40,
  ggx25,
  ggx15,
  ggx08,
  mix,          ///< diffuse under a clear coat: F0 = .06, alpha = .15
  anisotropic,  ///< alpha .5 along, .1 across
  fresnel       ///< F0 = .04, alpha = .1: hardly more than a rim at grazing angles
};
inline constexpr std::array kMaterialClasses{
    MaterialClass::lambert, MaterialClass::ggx60,       MaterialClass::ggx40,
    MaterialClass::ggx25,   MaterialClass::ggx15,       MaterialClass::ggx08,
    MaterialClass::mix,     MaterialClass::anisotropic, MaterialClass::fresnel};

std::string_view name_of(MaterialClass material);

/// Lambert plus GGX with Smith's height-correlated shadowing and Schlick's Fresnel term (Walter et
/// al. 2007, Heitz 2014). Directions in the tangent frame, z along the normal.
struct Material {
  Eigen::Vector3f albedo{0, 0, 0};  ///< of the diffuse part, [0, 1]
  Eigen::Vector3f f0{0, 0, 0};      ///< reflectance at normal incidence; zero: no specular part
  float alpha_x = 1;                ///< roughness along x and y, (0, 1]
  float alpha_y = 1;

  [[nodiscard]] bool is_glossy() const { return f0.maxCoeff() > 0; }
};

/// A material of a class with random colours.
Material random_material(MaterialClass material, Random& random);

/// Smith's Lambda of a direction with z > 0.
float smith_lambda(const Material& material, const Eigen::Vector3f& direction);

/// Reflected part f_r (1/sr) for light from `light` towards `view`, both unit with z > 0;
/// symmetric in the two.
Eigen::Vector3f reflectance(const Material& material, const Eigen::Vector3f& light,
                            const Eigen::Vector3f& view);

}  // namespace sheen::evaluation
