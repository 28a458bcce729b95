// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/option_table.h"
#include "fitting/sparse/options.h"

#include <optional>

namespace sheen::fitting::detail {

/// Where the model keeps how colours change with the direction.
enum class OffsetPlaces {
  vertex,
  anchors,
  automatic  ///< where they predict better what was not fitted (choose_offsets.h)
};

/// How a texture and patches are fitted.
struct Options {
  sparse::Options patches{};
  /// Side of a texel on the surface, millimetres, > 0. Nothing: a thousandth of the object's
  /// diagonal; who knows the camera gives what a pixel covers.
  std::optional<float> texel_mm{};
  /// While views arrive it is the vertices.
  OffsetPlaces offsets = OffsetPlaces::automatic;
  /// Distance of anchors, texels, > 0.
  double anchor_px = 6;

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

/// Name of the option that sets `texel_mm`.
inline constexpr const char* kTexelOption = "texel-mm";

/// What it may be.
inline constexpr double kLeastTexel_mm = 1e-4;
inline constexpr double kMostTexel_mm = 1e4;

inline constexpr double kLeastAnchor_px = 0.01;
inline constexpr double kMostAnchor_px = 1000;

OptionTable option_table(Options& options);

}  // namespace sheen::fitting::detail
