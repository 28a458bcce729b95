// SPDX-License-Identifier: MIT
#pragma once

#include "capture/synthetic/brdf.h"

#include <Eigen/Core>

#include <array>

namespace sheen::capture::synthetic {

/// A round soft box far away: a cone of directions of even brightness.
struct SoftBox {
  Eigen::Vector3f towards{0, 0, 1};     ///< unit vector to its centre, board frame
  Eigen::Vector3f irradiance{0, 0, 0};  ///< on a surface that faces it, linear RGB
  float radius_rad = 0;                 ///< half the cone's opening
};

inline constexpr std::size_t kSoftBoxes = 4;

/// All light that does not come from the object or the board.
struct Studio {
  std::array<SoftBox, kSoftBoxes> boxes;
  Eigen::Vector3f zenith{0, 0, 0};   ///< radiance of the room from above
  Eigen::Vector3f horizon{0, 0, 0};  ///< and from the side
  float exposure = 1;                ///< linear value = radiance * exposure; 1 is white
};

/// Warm key, cool fill, top light and a low rim, as for a photograph of a product.
Studio product_studio();

/// Radiance of the room without the soft boxes; `direction` is a unit vector in the board frame.
Eigen::Vector3f room_radiance(const Studio& studio, const Eigen::Vector3f& direction);

/// What reaches a point of a surface.
struct Incident {
  std::array<float, kSoftBoxes> visible{};      ///< share of each soft box the point sees, [0, 1]
  Eigen::Vector3f ambient_irradiance{0, 0, 0};  ///< from room and board
  float openness = 0;                           ///< share of the hemisphere not hidden, [0, 1]
};

/// Radiance towards the eye: Lambert, plus GGX with Schlick's Fresnel for `specular` > 0
/// (Walter et al. 2007). A soft box widens the lobe instead of being integrated (Karis 2013); the
/// widened lobe keeps its energy. `normal` and `towards_eye` are unit vectors in the board frame.
/// Zero where the eye is behind the surface.
Eigen::Vector3f reflected_radiance(const Brdf& brdf, const Eigen::Vector3f& normal,
                                   const Eigen::Vector3f& towards_eye, const Studio& studio,
                                   const Incident& incident);

}  // namespace sheen::capture::synthetic
