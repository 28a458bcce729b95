// SPDX-License-Identifier: MIT
#include "reconstruction/surface/edge_mesh.h"

#include "core/mesh/repair.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace sheen::reconstruction {
namespace {

using Index = EdgeMesh::Index;

constexpr float kLeastFacing = 0.5F;      // cosine by which a triangle may turn in a collapse
constexpr float kLeastFlipFacing = 0.9F;  // and between old and new triangles of a flip

Eigen::Vector3f normal_of(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                          const Eigen::Vector3f& c) {
  return (b - a).cross(c - a);
}

/// Finds every half-edge's twin by sorting them by their ends.
std::vector<Index> find_twins(const std::vector<Index>& vertices) {
  std::vector<std::tuple<Index, Index, Index>> edges;  // smaller end, larger end, half-edge
  edges.reserve(vertices.size());
  for (Index h = 0; h < vertices.size(); ++h) {
    const Index a = vertices[h];
    const Index b = vertices[EdgeMesh::next(h)];
    edges.emplace_back(std::min(a, b), std::max(a, b), h);
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Index> twins(vertices.size(), EdgeMesh::kNone);
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    if (i + 1 == edges.size()) throw std::invalid_argument("the mesh is not closed");
    const auto& [a0, a1, g] = edges[i];
    const auto& [b0, b1, h] = edges[i + 1];
    const bool pair = a0 == b0 && a1 == b1 && vertices[g] != vertices[h];
    const bool third =
        i + 2 < edges.size() && std::get<0>(edges[i + 2]) == a0 && std::get<1>(edges[i + 2]) == a1;
    if (!pair || third) throw std::invalid_argument("the mesh is not closed and manifold");
    twins[g] = h;
    twins[h] = g;
  }
  return twins;
}

}  // namespace

EdgeMesh::EdgeMesh(const core::Mesh& mesh) : positions_(mesh.positions) {
  vertices_.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) vertices_.push_back(triangle[corner]);
  }
  twins_ = find_twins(vertices_);
  outgoing_.assign(positions_.size(), kNone);
  std::vector<int> degree(positions_.size(), 0);
  for (Index h = 0; h < half_edges(); ++h) {
    outgoing_[vertices_[h]] = h;
    ++degree[vertices_[h]];
  }
  for (Index v = 0; v < vertex_count(); ++v) {
    if (outgoing_[v] != kNone && valence(v) != degree[v]) {
      throw std::invalid_argument("the mesh is not manifold at a vertex");
    }
  }
}

core::Mesh EdgeMesh::mesh() const {
  core::Mesh result;
  std::vector<Index> renumbered(positions_.size(), kNone);
  for (Index v = 0; v < vertex_count(); ++v) {
    if (outgoing_[v] == kNone) continue;
    renumbered[v] = static_cast<Index>(result.positions.size());
    result.positions.push_back(positions_[v]);
  }
  for (Index h = 0; h < half_edges(); h += 3) {
    if (!is_alive(h)) continue;
    result.triangles.emplace_back(renumbered[vertices_[h]], renumbered[vertices_[h + 1]],
                                  renumbered[vertices_[h + 2]]);
  }
  core::complete_normals(result);
  return result;
}

Eigen::Vector3f EdgeMesh::area_normal(Index triangle) const {
  return normal_of(positions_[vertices_[3 * triangle]], positions_[vertices_[3 * triangle + 1]],
                   positions_[vertices_[3 * triangle + 2]]);
}

Eigen::Vector3f EdgeMesh::vertex_normal(Index v) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for_each_outgoing(v, [&](Index h) { sum += area_normal(h / 3); });
  return sum;
}

int EdgeMesh::valence(Index v) const {
  int count = 0;
  for_each_outgoing(v, [&](Index) { ++count; });
  return count;
}

Index EdgeMesh::split(Index h) {
  // Triangles (a, b, c) and (b, a, d) become (a, m, c), (m, b, c), (b, m, d), (m, a, d).
  const Index g = twins_[h];
  const Index b = to(h);
  const Index a = from(h);
  const Index c = across(h);
  const Index d = across(g);
  const auto m = static_cast<Index>(positions_.size());
  positions_.push_back(0.5F * (positions_[a] + positions_[b]));
  const Index bc = next(h);
  const Index ad = next(g);
  const Index bc_twin = twins_[bc];
  const Index ad_twin = twins_[ad];
  const Index mbc = half_edges();  // m -> b, b -> c, c -> m
  const Index mad = mbc + 3;       // m -> a, a -> d, d -> m
  for (const Index v : {m, b, c, m, a, d}) vertices_.push_back(v);
  twins_.resize(vertices_.size(), kNone);
  vertices_[bc] = m;  // h: a -> m, then m -> c
  vertices_[ad] = m;  // g: b -> m, then m -> d
  join(mbc + 1, bc_twin);
  join(mad + 1, ad_twin);
  join(mbc + 2, bc);
  join(mad + 2, ad);
  join(mbc, g);
  join(mad, h);
  outgoing_.push_back(mbc);
  outgoing_[b] = mbc + 1;
  outgoing_[a] = h;
  outgoing_[c] = mbc + 2;
  outgoing_[d] = mad + 2;
  return m;
}

bool EdgeMesh::keeps_facing(Index h, Index moved, Index gone, const Eigen::Vector3f& place) const {
  // Triangles round `moved`, but for those that hold `gone` too.
  bool keeps = true;
  for_each_outgoing(moved, [&](Index out) {
    const Index b = to(out);
    const Index c = across(out);
    if (b == gone || c == gone || !keeps) return;
    const Eigen::Vector3f before = normal_of(positions_[moved], positions_[b], positions_[c]);
    const Eigen::Vector3f after = normal_of(place, positions_[b], positions_[c]);
    if (!(before.dot(after) > kLeastFacing * before.norm() * after.norm())) keeps = false;
    // No needles: the triangle keeps some height over its longest side.
    const float longest =
        std::max({(positions_[b] - place).squaredNorm(), (positions_[c] - place).squaredNorm(),
                  (positions_[b] - positions_[c]).squaredNorm()});
    if (after.norm() < 0.08F * longest) keeps = false;
  });
  static_cast<void>(h);
  return keeps;
}

bool EdgeMesh::may_collapse(Index h, const Eigen::Vector3f& place) const {
  const Index a = from(h);
  const Index b = to(h);
  const Index c = across(h);
  const Index d = across(twins_[h]);
  if (c == d || valence(c) <= 3 || valence(d) <= 3) return false;
  // Link condition: the ends share no neighbours but the two across.
  bool shares = false;
  for_each_outgoing(a, [&](Index out) {
    const Index n = to(out);
    if (n == b || n == c || n == d) return;
    for_each_outgoing(b, [&](Index other) { shares |= to(other) == n; });
  });
  if (shares) return false;
  return keeps_facing(h, a, b, place) && keeps_facing(h, b, a, place);
}

void EdgeMesh::collapse(Index h, const Eigen::Vector3f& place) {
  const Index g = twins_[h];
  const Index a = from(h);
  const Index b = to(h);
  const Index c = across(h);
  const Index d = across(g);
  // All that left a leaves b.
  std::vector<Index> leaving;
  for_each_outgoing(a, [&](Index out) { leaving.push_back(out); });
  for (const Index out : leaving) vertices_[out] = b;
  // Close the gaps of the two triangles.
  const Index bc = twins_[next(h)];      // c -> b
  const Index ca = twins_[previous(h)];  // a -> c, now b -> c
  const Index ad = twins_[next(g)];      // d -> a, now d -> b
  const Index db = twins_[previous(g)];  // b -> d
  join(bc, ca);
  join(ad, db);
  for (const Index removed : {h, next(h), previous(h), g, next(g), previous(g)}) {
    vertices_[removed] = kNone;
    twins_[removed] = kNone;
  }
  outgoing_[a] = kNone;
  outgoing_[b] = ca;
  outgoing_[c] = bc;
  outgoing_[d] = ad;
  positions_[b] = place;
}

bool EdgeMesh::may_flip(Index h) const {
  const Index g = twins_[h];
  const Index a = from(h);
  const Index b = to(h);
  const Index c = across(h);
  const Index d = across(g);
  if (valence(a) <= 3 || valence(b) <= 3) return false;
  bool is_edge = false;
  for_each_outgoing(c, [&](Index out) { is_edge |= to(out) == d; });
  if (is_edge) return false;
  const Eigen::Vector3f first = area_normal(h / 3);
  const Eigen::Vector3f second = area_normal(g / 3);
  const Eigen::Vector3f one = normal_of(positions_[c], positions_[d], positions_[b]);
  const Eigen::Vector3f other = normal_of(positions_[d], positions_[c], positions_[a]);
  const auto faces = [](const Eigen::Vector3f& m, const Eigen::Vector3f& n) {
    return m.dot(n) > kLeastFlipFacing * m.norm() * n.norm();
  };
  return faces(one, other) && faces(one, first) && faces(one, second) && faces(other, first) &&
         faces(other, second);
}

void EdgeMesh::flip(Index h) {
  // Triangles (a, b, c) and (b, a, d) become (d, b, c)... as (c, d, b) and (d, c, a).
  const Index g = twins_[h];
  const Index a = from(h);
  const Index b = to(h);
  const Index c = across(h);
  const Index d = across(g);
  const Index bc = twins_[next(h)];
  const Index ca = twins_[previous(h)];
  const Index ad = twins_[next(g)];
  const Index db = twins_[previous(g)];
  // h: c -> d, d -> b, b -> c;  g: d -> c, c -> a, a -> d.
  const Index h1 = next(h);
  const Index h2 = previous(h);
  const Index g1 = next(g);
  const Index g2 = previous(g);
  vertices_[h] = c;
  vertices_[h1] = d;
  vertices_[h2] = b;
  vertices_[g] = d;
  vertices_[g1] = c;
  vertices_[g2] = a;
  join(h1, db);
  join(h2, bc);
  join(g1, ca);
  join(g2, ad);
  outgoing_[a] = g2;
  outgoing_[b] = h2;
  outgoing_[c] = h;
  outgoing_[d] = g;
}

}  // namespace sheen::reconstruction
