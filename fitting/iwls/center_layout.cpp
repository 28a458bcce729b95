// SPDX-License-Identifier: MIT
#include "fitting/iwls/center_layout.h"

#include "core/geometry/disc_map.h"

#include <cassert>
#include <cmath>
#include <cstdint>

namespace sheen::fitting::iwls {
namespace {

bool is_jittered(Layout layout) {
  return layout == Layout::jittered_grid || layout == Layout::jittered_disk;
}

Eigen::Vector2f mapped(Layout layout, const Eigen::Vector2f& square) {
  const bool on_disk = layout == Layout::disk || layout == Layout::jittered_disk;
  return on_disk ? core::disc_from_square(square) : square;
}

// A number in (-1/2, 1/2) from an index. An own hash, because the distributions of <random> may
// differ between libraries and a layout must not.
float cell_offset(std::uint32_t index) {
  std::uint32_t x = index + 1;
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  x ^= x >> 16;
  return (static_cast<float>(x >> 8) + 0.5f) / 16777216.0f - 0.5f;
}

}  // namespace

CenterLayout make_center_layout(Layout layout, int centers) {
  assert(centers == 16 || centers == 64);
  CenterLayout result{layout, centers == 16 ? 4 : 8, {}};
  const float cell = static_cast<float>(spacing(result.side));
  for (int y = 0; y < result.side; ++y) {
    for (int x = 0; x < result.side; ++x) {
      Eigen::Vector2f square(-1.0f + cell * (static_cast<float>(x) + 0.5f),
                             -1.0f + cell * (static_cast<float>(y) + 0.5f));
      if (is_jittered(layout)) {
        const auto index = static_cast<std::uint32_t>(2 * (y * result.side + x));
        square += cell * Eigen::Vector2f(cell_offset(index), cell_offset(index + 1));
      }
      result.centers.push_back(mapped(layout, square));
    }
  }
  return result;
}

Eigen::Vector2f coarse_node_position(Layout layout, int side, int x, int y) {
  const float cell = static_cast<float>(spacing(side));
  return mapped(layout, {-1.0f + cell * (static_cast<float>(x) + 0.5f),
                         -1.0f + cell * (static_cast<float>(y) + 0.5f)});
}

double level_radius(int side) {
  return kRootRadius / std::sqrt(static_cast<double>(side));
}

double spacing(int side) {
  return 2.0 / side;
}

}  // namespace sheen::fitting::iwls
