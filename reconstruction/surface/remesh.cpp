// SPDX-License-Identifier: MIT
#include "reconstruction/surface/remesh.h"

#include "reconstruction/surface/edge_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace sheen::reconstruction {
namespace {

using Index = EdgeMesh::Index;

constexpr float kLongest = 4.0F / 3;
constexpr float kShortest = 4.0F / 5;
constexpr float kRelaxation = 0.6F;  // share of the way to the neighbours' middle
constexpr float kLeastTurned = 0.7F;

void split_long_edges(EdgeMesh& mesh, float longest, const ProjectOntoSurface& project) {
  // Each edge once: in flat triangles new edges may be as long as the old ones, for ever.
  const Index end = mesh.half_edges();
  for (Index h = 0; h < end; ++h) {
    if (!mesh.is_alive(h) || mesh.twin(h) < h || !(mesh.length(h) > longest)) continue;
    const Index m = mesh.split(h);
    mesh.move(m, project(mesh.position(m)));
  }
}

/// Whether an edge to the place where a collapse ends would be too long.
bool makes_long_edge(const EdgeMesh& mesh, Index h, const Eigen::Vector3f& place, float longest) {
  bool is_long = false;
  for (const Index end : {mesh.from(h), mesh.to(h)}) {
    mesh.for_each_outgoing(
        end, [&](Index out) { is_long |= (mesh.position(mesh.to(out)) - place).norm() > longest; });
  }
  return is_long;
}

void collapse_short_edges(EdgeMesh& mesh, float shortest, float longest,
                          const ProjectOntoSurface& project) {
  for (Index h = 0; h < mesh.half_edges(); ++h) {
    if (!mesh.is_alive(h) || !(mesh.length(h) < shortest)) continue;
    const Eigen::Vector3f middle = 0.5F * (mesh.position(mesh.from(h)) + mesh.position(mesh.to(h)));
    if (makes_long_edge(mesh, h, middle, longest)) continue;
    if (!mesh.may_collapse(h, middle)) continue;
    const Index kept = mesh.to(h);
    mesh.collapse(h, middle);
    const Eigen::Vector3f place = project(middle);
    // Only where the projection is no jump to another sheet.
    if ((place - middle).norm() < 0.5F * shortest) mesh.move(kept, place);
  }
}

void even_valences(EdgeMesh& mesh) {
  for (Index h = 0; h < mesh.half_edges(); ++h) {
    if (!mesh.is_alive(h) || mesh.twin(h) < h) continue;
    const int a = mesh.valence(mesh.from(h)) - 6;
    const int b = mesh.valence(mesh.to(h)) - 6;
    const int c = mesh.valence(mesh.across(h)) - 6;
    const int d = mesh.valence(mesh.across(mesh.twin(h))) - 6;
    const int now = a * a + b * b + c * c + d * d;
    const int then = (a - 1) * (a - 1) + (b - 1) * (b - 1) + (c + 1) * (c + 1) + (d + 1) * (d + 1);
    if (then < now && mesh.may_flip(h)) mesh.flip(h);
  }
}

/// Moves a vertex unless that turns one of its triangles too far.
void move_carefully(EdgeMesh& mesh, Index v, const Eigen::Vector3f& place) {
  bool folds = false;
  mesh.for_each_outgoing(v, [&](Index h) {
    const Eigen::Vector3f& b = mesh.position(mesh.to(h));
    const Eigen::Vector3f& c = mesh.position(mesh.across(h));
    const Eigen::Vector3f before = (b - mesh.position(v)).cross(c - mesh.position(v));
    const Eigen::Vector3f after = (b - place).cross(c - place);
    folds |= !(before.dot(after) > kLeastTurned * before.norm() * after.norm());
  });
  if (!folds) mesh.move(v, place);
}

void relax(EdgeMesh& mesh, const ProjectOntoSurface& project) {
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!mesh.has_vertex(v)) continue;
    Eigen::Vector3f centre = Eigen::Vector3f::Zero();
    float count = 0;
    mesh.for_each_outgoing(v, [&](Index h) {
      centre += mesh.position(mesh.to(h));
      count += 1;
    });
    centre /= count;
    const Eigen::Vector3f normal = mesh.vertex_normal(v).normalized();
    if (!normal.allFinite()) continue;
    Eigen::Vector3f step = kRelaxation * (centre - mesh.position(v));
    step -= step.dot(normal) * normal;
    move_carefully(mesh, v, project(mesh.position(v) + step));
  }
}

}  // namespace

core::Mesh remesh(const core::Mesh& mesh, float edge_m, int rounds,
                  const ProjectOntoSurface& project) {
  EdgeMesh edges(mesh);
  for (int round = 0; round < rounds; ++round) {
    split_long_edges(edges, kLongest * edge_m, project);
    collapse_short_edges(edges, kShortest * edge_m, kLongest * edge_m, project);
    even_valences(edges);
    relax(edges, project);
  }
  return edges.mesh();
}

}  // namespace sheen::reconstruction
