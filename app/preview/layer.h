// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace sheen::app {

/// What the object is painted with. The two scores are never mixed: one asks for views, the other
/// says that views do not help.
enum class Layer { radiance, needs_views, misfit, mesh };
inline constexpr std::array kLayers{Layer::radiance, Layer::needs_views, Layer::misfit,
                                    Layer::mesh};

constexpr std::string_view name_of(Layer layer) {
  switch (layer) {
    case Layer::needs_views:
      return "Needs views";
    case Layer::misfit:
      return "Does not fit";
    case Layer::mesh:
      return "Mesh";
    case Layer::radiance:
      break;
  }
  return "Radiance";
}

}  // namespace sheen::app
