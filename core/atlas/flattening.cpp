// SPDX-License-Identifier: MIT
#include "core/atlas/flattening.h"

#include "core/mesh/triangle_neighbours.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace sheen::core {
namespace {

using Sides = std::array<std::uint32_t, 3>;

constexpr std::size_t kMostDirections = 12;
/// Slant that is worth a further direction where much of the surface has it.
constexpr float kSteepCosine = 0.55f;
constexpr float kSteepShare = 0.02f;

std::uint8_t nearest(const std::vector<Eigen::Vector3f>& directions,
                     const Eigen::Vector3f& normal) {
  std::size_t best = 0;
  for (std::size_t d = 1; d < directions.size(); ++d) {
    if (directions[d].dot(normal) > directions[best].dot(normal)) best = d;
  }
  return static_cast<std::uint8_t>(best);
}

/// Spherical k-means; a direction that nobody takes stays where it is.
void settle(const TriangleShapes& shapes, Flattening& flat) {
  constexpr int rounds = 10;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Eigen::Vector3d> sums(flat.directions.size(), Eigen::Vector3d::Zero());
    for (std::size_t t = 0; t < shapes.normal.size(); ++t) {
      flat.of_triangle[t] = nearest(flat.directions, shapes.normal[t]);
      sums[flat.of_triangle[t]] += (shapes.area_m2[t] * shapes.normal[t]).template cast<double>();
    }
    for (std::size_t d = 0; d < sums.size(); ++d) {
      const double length = sums[d].norm();
      if (length > 0) flat.directions[d] = (sums[d] / length).cast<float>();
    }
  }
  for (std::size_t t = 0; t < shapes.normal.size(); ++t) {
    flat.of_triangle[t] = nearest(flat.directions, shapes.normal[t]);
  }
}

/// The mean normal of what is slanted most, if that is a share of the surface worth a direction.
bool add_direction(const TriangleShapes& shapes, Flattening& flat) {
  double total = 0;
  double steep = 0;
  std::size_t worst = 0;
  float worst_cosine = 1;
  const auto cosine = [&](std::size_t t) {
    return flat.directions[flat.of_triangle[t]].dot(shapes.normal[t]);
  };
  for (std::size_t t = 0; t < shapes.normal.size(); ++t) {
    total += static_cast<double>(shapes.area_m2[t]);
    if (!(shapes.area_m2[t] > 0.0f) || cosine(t) >= kSteepCosine) continue;
    steep += static_cast<double>(shapes.area_m2[t]);
    if (cosine(t) < worst_cosine) {
      worst_cosine = cosine(t);
      worst = t;
    }
  }
  if (!(steep > static_cast<double>(kSteepShare) * total)) return false;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t t = 0; t < shapes.normal.size(); ++t) {
    const bool near_worst = shapes.normal[t].dot(shapes.normal[worst]) > kSteepCosine;
    if (near_worst && cosine(t) < kSteepCosine) sum += shapes.area_m2[t] * shapes.normal[t];
  }
  flat.directions.push_back(sum.norm() > 0.0f ? Eigen::Vector3f(sum.normalized())
                                              : shapes.normal[worst]);
  return true;
}

/// The costs that are minimised, of single triangles and of their sides.
class Costs {
 public:
  Costs(const Mesh& mesh, const TriangleShapes& shapes, const std::vector<Sides>& neighbours,
        float boundary_m)
      : mesh_(mesh), shapes_(shapes), neighbours_(neighbours), boundary_m_(boundary_m) {}

  [[nodiscard]] float slant(std::size_t t, const Eigen::Vector3f& direction) const {
    const float cosine = shapes_.normal[t].dot(direction);
    if (shapes_.area_m2[t] > 0.0f && cosine < kLeastFlatteningCosine) {
      return std::numeric_limits<float>::infinity();
    }
    return shapes_.area_m2[t] * (1.0f - cosine);
  }
  [[nodiscard]] float side(std::size_t t, std::size_t i) const {
    const auto corner = static_cast<Eigen::Index>(i);
    const auto& triangle = mesh_.triangles[t];
    return boundary_m_ *
           (mesh_.positions[triangle[corner]] - mesh_.positions[triangle[(corner + 1) % 3]]).norm();
  }
  [[nodiscard]] const Sides& neighbours(std::size_t t) const { return neighbours_[t]; }
  [[nodiscard]] float area_m2(std::size_t t) const { return shapes_.area_m2[t]; }

 private:
  const Mesh& mesh_;
  const TriangleShapes& shapes_;
  const std::vector<Sides>& neighbours_;
  float boundary_m_;
};

/// Gives a triangle the cheapest of its neighbours' directions; returns whether it changed.
bool improve_triangle(const Costs& costs, std::size_t t, Flattening& flat) {
  const auto cost = [&](std::uint8_t label) {
    float sum = costs.slant(t, flat.directions[label]);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t other = costs.neighbours(t)[i];
      if (other != kNoTriangle && flat.of_triangle[other] != label) sum += costs.side(t, i);
    }
    return sum;
  };
  std::uint8_t best = flat.of_triangle[t];
  float least = cost(best);
  for (const std::uint32_t other : costs.neighbours(t)) {
    if (other == kNoTriangle || flat.of_triangle[other] == best) continue;
    const float asked = cost(flat.of_triangle[other]);
    if (!(asked < least)) continue;
    least = asked;
    best = flat.of_triangle[other];
  }
  return std::exchange(flat.of_triangle[t], best) != best;
}

void improve_triangles(const Costs& costs, Flattening& flat) {
  constexpr int most_sweeps = 8;
  bool changed = true;
  for (int sweep = 0; sweep < most_sweeps && changed; ++sweep) {
    changed = false;
    for (std::size_t t = 0; t < flat.of_triangle.size(); ++t) {
      changed = improve_triangle(costs, t, flat) || changed;
    }
  }
}

/// Connected triangles of one direction.
std::vector<std::vector<std::uint32_t>> regions_of(const Costs& costs, const Flattening& flat) {
  std::vector<std::vector<std::uint32_t>> regions;
  std::vector<std::uint8_t> taken(flat.of_triangle.size(), 0);
  for (std::uint32_t seed = 0; seed < taken.size(); ++seed) {
    if (taken[seed] != 0) continue;
    std::vector<std::uint32_t> region{seed};
    taken[seed] = 1;
    for (std::size_t head = 0; head < region.size(); ++head) {
      for (const std::uint32_t other : costs.neighbours(region[head])) {
        if (other == kNoTriangle || taken[other] != 0) continue;
        if (flat.of_triangle[other] != flat.of_triangle[seed]) continue;
        taken[other] = 1;
        region.push_back(other);
      }
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

/// Gives a whole region the direction of the neighbour that makes the sum least.
bool improve_region(const Costs& costs, const std::vector<std::uint32_t>& region,
                    Flattening& flat) {
  // What each direction around would save: boundary that goes, less slant that comes.
  const std::uint8_t own = flat.of_triangle[region.front()];
  std::map<std::uint8_t, float> saved;
  for (const std::uint32_t t : region) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t other = costs.neighbours(t)[i];
      if (other == kNoTriangle || flat.of_triangle[other] == own) continue;
      saved[flat.of_triangle[other]] += costs.side(t, i);
    }
  }
  std::uint8_t best = own;
  float most = 0;
  for (auto& [label, gain] : saved) {
    for (const std::uint32_t t : region) {
      gain -= costs.slant(t, flat.directions[label]);
      const float before = costs.slant(t, flat.directions[own]);
      if (before < std::numeric_limits<float>::infinity()) gain += before;
    }
    if (gain > most) {
      most = gain;
      best = label;
    }
  }
  for (const std::uint32_t t : region) flat.of_triangle[t] = best;
  return best != own;
}

void improve_regions(const Costs& costs, Flattening& flat) {
  constexpr int most_rounds = 6;
  for (int round = 0; round < most_rounds; ++round) {
    auto regions = regions_of(costs, flat);
    const auto area = [&](const std::vector<std::uint32_t>& region) {
      return std::accumulate(region.begin(), region.end(), 0.0f,
                             [&](float sum, std::uint32_t t) { return sum + costs.area_m2(t); });
    };
    std::vector<std::pair<float, std::size_t>> order;
    for (std::size_t r = 0; r < regions.size(); ++r) order.emplace_back(area(regions[r]), r);
    std::sort(order.begin(), order.end());
    bool changed = false;
    for (const auto& [unused, r] : order) {
      changed = improve_region(costs, regions[r], flat) || changed;
    }
    if (!changed) break;
  }
}

}  // namespace

Flattening flatten(const Mesh& mesh, const TriangleShapes& shapes,
                   const std::vector<Sides>& neighbours, float boundary_m) {
  Flattening flat;
  for (int axis = 0; axis < 3; ++axis) {
    flat.directions.emplace_back(Eigen::Vector3f::Unit(axis));
    flat.directions.emplace_back(-Eigen::Vector3f::Unit(axis));
  }
  flat.of_triangle.resize(mesh.triangles.size());
  settle(shapes, flat);
  while (flat.directions.size() < kMostDirections && add_direction(shapes, flat)) {
    settle(shapes, flat);
  }
  const Costs costs(mesh, shapes, neighbours, boundary_m);
  improve_triangles(costs, flat);
  improve_regions(costs, flat);
  return flat;
}

}  // namespace sheen::core
