// SPDX-License-Identifier: MIT
#include "fitting/patch_fitter.h"

#include "fitting/descriptor.h"

#include <stdexcept>
#include <string>

namespace sheen::fitting {

std::unique_ptr<PatchFitter> make_isolated_patches(std::string_view representation,
                                                   std::size_t patch_count,
                                                   const OptionValues& values, int threads) {
  core::Mesh points;
  points.positions.assign(patch_count, Eigen::Vector3f::Zero());
  points.normals.assign(patch_count, Eigen::Vector3f::UnitZ());
  auto fitter = make_fitter(representation, points, values, threads);
  if (auto* const patches = dynamic_cast<PatchFitter*>(fitter.get())) {
    static_cast<void>(fitter.release());
    return std::unique_ptr<PatchFitter>(patches);
  }
  throw std::invalid_argument("representation \"" + std::string(representation) +
                              "\" has no patches");
}

}  // namespace sheen::fitting
