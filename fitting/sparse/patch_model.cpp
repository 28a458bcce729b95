// SPDX-License-Identifier: MIT
#include "fitting/sparse/patch_model.h"

#include "core/geometry/disc_map.h"
#include "fitting/iwls/wendland.h"

#include <cmath>

namespace sheen::fitting::sparse {

Eigen::Vector3f evaluate(const PatchModel& model, const Eigen::Vector2f& uv) {
  const Eigen::Vector3f direction = core::hemisphere_from_disc(uv);
  Eigen::Vector3f colour = model.coefficient[0];
  if (model.base_terms == kLinearBase) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      colour += direction[static_cast<Eigen::Index>(axis)] * model.coefficient[1 + axis];
    }
  }
  const std::span<const Atom> dictionary = atoms();
  for (std::size_t rbf = 0; rbf < model.rbf_count; ++rbf) {
    const Atom& atom = dictionary[model.atom[rbf]];
    const float squared = (direction.head<2>() - atom.center).squaredNorm();
    if (squared >= atom.support * atom.support) continue;
    colour += iwls::wendland(std::sqrt(squared) / atom.support) *
              model.coefficient[model.base_terms + rbf];
  }
  return colour;
}

Eigen::Vector3f disc_mean(const PatchModel& model) {
  Eigen::Vector3f colour = model.coefficient[0];
  // x and y cancel; the mean of z = sqrt(1 - r^2) over the disc is the integral of 2 r z dr = 2/3.
  if (model.base_terms == kLinearBase) colour += 2.0f / 3.0f * model.coefficient[3];
  for (std::size_t rbf = 0; rbf < model.rbf_count; ++rbf) {
    colour += atom_means()[model.atom[rbf]] * model.coefficient[model.base_terms + rbf];
  }
  return colour;
}

}  // namespace sheen::fitting::sparse
