// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

namespace sheen::capture::synthetic {

/// Smallest and largest number of vertices `torus_knot` is asked for.
inline constexpr int kMinKnotVertices = 500;
inline constexpr int kMaxKnotVertices = 2'000'000;

/// A trefoil: a round tube along the (2, 3) torus knot, 15 cm across and 7.5 cm high, centred on
/// the origin, z up. Closed, welded, counter-clockwise from outside, exact normals. It hides parts
/// of itself from every side, which is what a visibility test is for. `vertices` is met to within
/// the size of one ring of the tube.
core::Mesh torus_knot(int vertices);

}  // namespace sheen::capture::synthetic
