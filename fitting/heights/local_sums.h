// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/heights/height_field.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace sheen::fitting::heights {

/// How many edges away from a height its neighbourhood reaches: to about eight pixels, but at least
/// one. Within it a change of brightness from view to view is taken to be gloss.
inline int neighbourhood_edges(const HeightField& field, double pixel_m) {
  constexpr double reach_px = 8;
  constexpr double most_edges = 5;
  double length_m = 0;
  for (const HeightField::Edge& edge : field.edges()) {
    length_m += static_cast<double>(edge.length_m);
  }
  if (!(length_m > 0)) return 1;
  const double mean_m = length_m / static_cast<double>(field.edges().size());
  return static_cast<int>(std::clamp(std::round(reach_px * pixel_m / mean_m), 1.0, most_edges));
}

/// Sums over the triangles around every height, weighted less the more edges they are away.
/// `triangles` has the sums of each.
template <typename Sums>
std::vector<Sums> sums_around(const HeightField& field, const core::Mesh& mesh,
                              const std::vector<Sums>& triangles, int edges) {
  std::vector<Sums> around(field.size(), Sums::Zero());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      around[field.of_vertex(vertex)] += triangles[t];
    }
  }
  for (int round = 1; round < edges; ++round) {
    std::vector<Sums> wider = around;
    for (const HeightField::Edge& edge : field.edges()) {
      wider[edge.first] += around[edge.second];
      wider[edge.second] += around[edge.first];
    }
    around.swap(wider);
  }
  return around;
}

}  // namespace sheen::fitting::heights
