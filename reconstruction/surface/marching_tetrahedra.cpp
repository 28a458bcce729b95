// SPDX-License-Identifier: MIT
#include "reconstruction/surface/marching_tetrahedra.h"

#include "core/mesh/repair.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace sheen::reconstruction {
namespace {

using Triangle = Eigen::Matrix<std::uint32_t, 3, 1>;

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr float kNearest = 0.02F;  // of a vertex to a grid point, shares of a cell

/// Corners of a cell are numbered by their bits: x, y, z. Kuhn's cut: each tetrahedron runs from
/// corner 0 to corner 7 along the axes in one of their six orders, so that neighbouring cells cut
/// the faces between them alike. The first three are even orders.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra{
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 2, 3, 7}, {0, 1, 5, 7}, {0, 4, 6, 7}}};

class Marcher {
 public:
  explicit Marcher(const DistanceGrid& grid) : grid_(grid), size_(grid.size()) {
    const auto layer = static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y());
    for (auto& edges : edges_) edges.assign(layer * 8, kNone);
  }

  core::Mesh run() {
    for (int z = 0; z + 1 < size_.z(); ++z) {
      for (int y = 0; y + 1 < size_.y(); ++y) {
        for (int x = 0; x + 1 < size_.x(); ++x) march_cell(x, y, z);
      }
      // The upper layer becomes the lower one.
      std::swap(edges_[0], edges_[1]);
      std::fill(edges_[1].begin(), edges_[1].end(), kNone);
    }
    core::complete_normals(mesh_);
    return std::move(mesh_);
  }

 private:
  /// Value at a grid point; the boundary is outside.
  [[nodiscard]] float value(int x, int y, int z) const {
    const float v = grid_[grid_.index(x, y, z)];
    const bool at_boundary = x == 0 || y == 0 || z == 0 || x == size_.x() - 1 ||
                             y == size_.y() - 1 || z == size_.z() - 1;
    return at_boundary ? std::max(v, 0.5F * grid_.cell_m()) : v;
  }

  void march_cell(int x, int y, int z) {
    std::array<float, 8> values{};
    int inside = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const auto i = static_cast<std::size_t>(corner);
      values[i] = value(x + (corner & 1), y + ((corner >> 1) & 1), z + (corner >> 2));
      inside += values[i] < 0 ? 1 : 0;
    }
    if (inside == 0 || inside == 8) return;
    for (std::size_t t = 0; t < kTetrahedra.size(); ++t) {
      march_tetrahedron(x, y, z, values, kTetrahedra[t], t < 3);
    }
  }

  void march_tetrahedron(int x, int y, int z, const std::array<float, 8>& values,
                         const std::array<int, 4>& corners, bool is_even) {
    std::array<int, 4> in{};
    std::array<int, 4> out{};
    std::size_t ins = 0;
    std::size_t outs = 0;
    std::array<std::size_t, 4> in_place{};
    std::array<std::size_t, 4> out_place{};
    for (std::size_t i = 0; i < 4; ++i) {
      const int corner = corners[i];
      if (values[static_cast<std::size_t>(corner)] < 0) {
        in_place[ins] = i;
        in[ins++] = corner;
      } else {
        out_place[outs] = i;
        out[outs++] = corner;
      }
    }
    const auto vertex = [&](int a, int b) { return vertex_between(x, y, z, values, a, b); };
    // Parity of the order (in..., out...) against (0, 1, 2, 3) decides the winding.
    if (ins == 1) {
      const bool flip = (in_place[0] % 2 == 1) != !is_even;
      add(vertex(in[0], out[0]), vertex(in[0], out[1]), vertex(in[0], out[2]), flip);
    } else if (ins == 3) {
      const bool flip = (out_place[0] % 2 == 0) != !is_even;
      add(vertex(in[0], out[0]), vertex(in[1], out[0]), vertex(in[2], out[0]), flip);
    } else if (ins == 2) {
      const std::size_t a = in_place[0];
      const std::size_t b = in_place[1];
      const bool odd = (a + b) % 2 == 0;  // of the order (a, b, rest ascending)
      const bool flip = odd != !is_even;
      const std::uint32_t v00 = vertex(in[0], out[0]);
      const std::uint32_t v01 = vertex(in[0], out[1]);
      const std::uint32_t v10 = vertex(in[1], out[0]);
      const std::uint32_t v11 = vertex(in[1], out[1]);
      add(v00, v01, v11, flip);
      add(v00, v11, v10, flip);
    }
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool flip) {
    mesh_.triangles.push_back(flip ? Triangle(a, c, b) : Triangle(a, b, c));
  }

  /// The vertex on the edge between two corners of a cell, made at its first use.
  std::uint32_t vertex_between(int x, int y, int z, const std::array<float, 8>& values, int a,
                               int b) {
    const int low = a & b;  // one is reached from the other along axes, so this is one of them
    const int high = a | b;
    const int ox = x + (low & 1);
    const int oy = y + ((low >> 1) & 1);
    const int above = low >> 2;
    const auto slot = (static_cast<std::size_t>(oy) * static_cast<std::size_t>(size_.x()) +
                       static_cast<std::size_t>(ox)) *
                          8 +
                      static_cast<std::size_t>(high ^ low);
    std::uint32_t& vertex = edges_[static_cast<std::size_t>(above)][slot];
    if (vertex == kNone) {
      const float from = values[static_cast<std::size_t>(low)];
      const float to = values[static_cast<std::size_t>(high)];
      const float share = std::clamp(from / (from - to), kNearest, 1 - kNearest);
      const Eigen::Vector3f begin = grid_.point(ox, oy, z + above);
      const Eigen::Vector3f end =
          grid_.point(x + (high & 1), y + ((high >> 1) & 1), z + (high >> 2));
      vertex = static_cast<std::uint32_t>(mesh_.positions.size());
      mesh_.positions.push_back(begin + share * (end - begin));
    }
    return vertex;
  }

  const DistanceGrid& grid_;
  Eigen::Array3i size_;
  std::array<std::vector<std::uint32_t>, 2>
      edges_;  ///< vertices by lower end: layer z, layer z + 1
  core::Mesh mesh_;
};

}  // namespace

core::Mesh march_tetrahedra(const DistanceGrid& grid) {
  return Marcher(grid).run();
}

}  // namespace sheen::reconstruction
