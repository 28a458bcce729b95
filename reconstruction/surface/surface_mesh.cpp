// SPDX-License-Identifier: MIT
#include "reconstruction/surface/surface_mesh.h"

#include "core/mesh/repair.h"
#include "reconstruction/refine/displacement.h"
#include "reconstruction/refine/normal_filter.h"
#include "reconstruction/refine/rims.h"
#include "reconstruction/surface/marching_tetrahedra.h"
#include "reconstruction/surface/remesh.h"
#include "reconstruction/surface/triangle_tree.h"
#include "reconstruction/surface/untangle.h"

#include <algorithm>
#include <cmath>

namespace sheen::reconstruction {
namespace {

constexpr float kEdge_px = 2.5F;
constexpr float kEdgeCells = 1.5F;  // shorter edges would show the grid
constexpr double kMostTriangles = 60000;
constexpr int kRemeshRounds = 5;
constexpr int kRefineRounds = 4;
constexpr float kRimReach_px = 3;
constexpr float kLargestStep = 0.5F;  // of an edge, in one round
constexpr NormalFilter kFilter{.rounds = 8, .turn = 0.35F};
constexpr DisplacementWeights kWeights{.rims = 1, .smoothness = 1, .stay = 0.02F};
constexpr float kFallbackCell = 1.8F;  // of an edge: as many triangles as remeshing makes

double area_of(const core::Mesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    area += 0.5 * static_cast<double>((mesh.positions[t[1]] - mesh.positions[t[0]])
                                          .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
                                          .norm());
  }
  return area;
}

float edge_length(const SurfaceInputs& inputs) {
  const double per_triangle = std::sqrt(3.0) / 4;
  const auto affordable =
      static_cast<float>(std::sqrt(area_of(inputs.hull) / (per_triangle * kMostTriangles)));
  return std::max({kEdge_px * inputs.pixel_m, kEdgeCells * inputs.grid.cell_m(), affordable});
}

/// A place near the hull moved onto phi = 0 by Newton steps.
ProjectOntoSurface onto_zero(const DistanceGrid& grid) {
  return [&grid](const Eigen::Vector3f& start) {
    Eigen::Vector3f point = start;
    for (int step = 0; step < 3; ++step) {
      const Eigen::Vector3f gradient = grid.gradient_at(point);
      const float slope = gradient.squaredNorm();
      if (!(slope > 0.01F)) return point;
      Eigen::Vector3f move = -grid.value_at(point) / slope * gradient;
      const float length = move.norm();
      if (length > grid.cell_m()) move *= grid.cell_m() / length;
      point += move;
    }
    return point;
  };
}

ProjectOntoSurface onto_mesh(const TriangleTree& tree) {
  return [&tree](const Eigen::Vector3f& point) { return tree.closest(point).point; };
}

void move_vertices(core::Mesh& mesh, const std::vector<float>& displacement, float largest_m) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.positions[i] += std::clamp(displacement[i], -largest_m, largest_m) * mesh.normals[i];
    // The sheet carries the object.
    mesh.positions[i].z() = std::max(mesh.positions[i].z(), 0.0F);
  }
  mesh.normals.clear();
  core::complete_normals(mesh);
}

/// How sure the vertices are: rims seen there, spread to neighbours, ten of them being enough.
std::vector<float> confidence_of(const core::Mesh& mesh, const std::vector<RimPoint>& rims) {
  constexpr float enough = 10;
  constexpr int spread_rounds = 2;
  std::vector<float> seen(mesh.positions.size(), 0);
  for (const RimPoint& rim : rims) {
    seen[rim.vertices[0]] += (1 - rim.share) * rim.weight;
    seen[rim.vertices[1]] += rim.share * rim.weight;
  }
  for (int round = 0; round < spread_rounds; ++round) {
    std::vector<float> sum = seen;
    std::vector<float> count(seen.size(), 1);
    for (const auto& t : mesh.triangles) {
      for (int c = 0; c < 3; ++c) {
        sum[t[c]] += seen[t[(c + 1) % 3]];
        count[t[c]] += 1;
      }
    }
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = sum[i] / count[i];
  }
  for (float& value : seen) value = std::min(1.0F, value / enough);
  return seen;
}

/// The same distances on coarser points.
DistanceGrid resampled(const DistanceGrid& grid, float cell_m) {
  DistanceGrid coarse(grid.box(), cell_m, 0);
  for (std::size_t i = 0; i < coarse.count(); ++i) coarse[i] = grid.value_at(coarse.point(i));
  return coarse;
}

}  // namespace

Surface make_surface_mesh(const SurfaceInputs& inputs, int threads, const WorkProgress& progress) {
  Surface surface;
  surface.edge_m = edge_length(inputs);
  progress("surface", 0, kRefineRounds + 2);
  core::Mesh mesh = remesh(inputs.hull, surface.edge_m, kRemeshRounds, onto_zero(inputs.grid));
  progress("surface", 1, kRefineRounds + 2);
  for (int round = 0; round < kRefineRounds; ++round) {
    const auto rims = find_rims(inputs.views, inputs.backgrounds, mesh, kRimReach_px, threads);
    const auto normals = filtered_normals(mesh, kFilter, threads);
    move_vertices(mesh, solve_displacement(mesh, rims, normals, kWeights),
                  kLargestStep * surface.edge_m);
    progress("surface", 2 + round, kRefineRounds + 2);
  }
  {
    const core::Mesh moved = mesh;
    const TriangleTree tree(moved);
    mesh = remesh(moved, surface.edge_m, 2, onto_mesh(tree));
  }
  bool is_simple = untangle(mesh, threads);
  surface.is_refined = is_simple;
  if (!is_simple) {
    mesh = remesh(inputs.hull, surface.edge_m, kRemeshRounds, onto_zero(inputs.grid));
    is_simple = untangle(mesh, threads);
  }
  if (!is_simple) {
    mesh = march_tetrahedra(
        resampled(inputs.grid, kFallbackCell * surface.edge_m));  // never crosses itself
  }
  surface.confidence =
      confidence_of(mesh, find_rims(inputs.views, inputs.backgrounds, mesh, kRimReach_px, threads));
  surface.mesh = std::move(mesh);
  progress("surface", kRefineRounds + 2, kRefineRounds + 2);
  return surface;
}

}  // namespace sheen::reconstruction
