// SPDX-License-Identifier: MIT
#include "fitting/patch_light_field.h"

#include "core/diagnostics/error.h"

#include <cassert>
#include <string>

namespace sheen::fitting {

std::vector<Eigen::Vector3f> PatchLightField::vertex_colours(
    [[maybe_unused]] const core::Mesh& mesh) const {
  assert(mesh.positions.size() == patch_count());
  std::vector<Eigen::Vector3f> colours(patch_count());
  for (std::size_t patch = 0; patch < colours.size(); ++patch) colours[patch] = mean_colour(patch);
  return colours;
}

const PatchLightField* as_patches(const LightField& light_field) {
  return dynamic_cast<const PatchLightField*>(&light_field);
}

const PatchLightField& require_patches(const LightField& light_field, std::string_view purpose) {
  if (const PatchLightField* const patches = as_patches(light_field)) return *patches;
  throw core::bad_input("representation " + std::string(light_field.representation()),
                        std::string(purpose) + " needs a light field of patches",
                        "choose another --representation, such as sparse");
}

}  // namespace sheen::fitting
