// SPDX-License-Identifier: MIT
#include "fitting/detail/anchor_layout.h"

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace sheen::fitting::detail {
namespace {

/// Distance at which an anchor's weight ends, in spacings: at most four or five are that near.
constexpr float kReach = 1.5f;

/// Far more anchors than fit into a cell of places that can be told apart; a hostile file may have
/// others.
constexpr std::size_t kMostInCell = 256;

/// Anchors by the cell of a grid in which they lie.
class AnchorGrid {
 public:
  AnchorGrid(const core::Mesh& mesh, float spacing_m)
      : mesh_(mesh), spacing_m_(spacing_m), cell_m_(kReach * spacing_m) {}

  /// Adds a vertex as the next anchor unless one is nearer than the spacing; returns whether it was
  /// added.
  bool add(std::uint32_t vertex) {
    bool is_free = true;
    for_each_near(vertex, [&](std::uint32_t /*anchor*/, float distance_m) {
      is_free = is_free && distance_m >= spacing_m_;
    });
    std::vector<Placed>& cell = cells_[key(cell_of(vertex))];
    if (!is_free || cell.size() == kMostInCell) return false;
    cell.push_back({count_++, vertex});
    return true;
  }

  /// Calls visit(anchor, distance) for all within reach of a vertex.
  template <typename Visit>
  void for_each_near(std::uint32_t vertex, const Visit& visit) const {
    const Cell middle = cell_of(vertex);
    for (std::int64_t z = -1; z <= 1; ++z) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        for (std::int64_t x = -1; x <= 1; ++x) {
          const auto cell = cells_.find(key({middle[0] + x, middle[1] + y, middle[2] + z}));
          if (cell == cells_.end()) continue;
          for (const auto& [anchor, at] : cell->second) {
            const float distance_m = distance(vertex, at);
            if (distance_m < cell_m_) visit(anchor, distance_m);
          }
        }
      }
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Placed {
    std::uint32_t anchor, vertex;
  };

  [[nodiscard]] Cell cell_of(std::uint32_t vertex) const {
    constexpr float farthest = 1e6f;  // cells; beyond, several share one
    Cell cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float at = mesh_.positions[vertex][static_cast<Eigen::Index>(axis)] / cell_m_;
      cell[axis] = static_cast<std::int64_t>(std::floor(std::clamp(at, -farthest, farthest)));
    }
    return cell;
  }
  static std::uint64_t key(const Cell& cell) {
    constexpr std::int64_t middle = std::int64_t{1} << 20;
    std::uint64_t bits = 0;
    for (const std::int64_t at : cell) bits = bits << 21 | static_cast<std::uint64_t>(at + middle);
    return bits;
  }
  [[nodiscard]] float distance(std::uint32_t a, std::uint32_t b) const {
    const float places = (mesh_.positions[a] - mesh_.positions[b]).squaredNorm();
    const float normals = (mesh_.normals[a] - mesh_.normals[b]).squaredNorm();
    return std::sqrt(places + spacing_m_ * spacing_m_ * normals);
  }

  const core::Mesh& mesh_;
  float spacing_m_, cell_m_;
  std::uint32_t count_ = 0;
  std::unordered_map<std::uint64_t, std::vector<Placed>> cells_;
};

AnchorBlend blend_at(const AnchorGrid& grid, std::uint32_t vertex, float spacing_m) {
  // Find the nearest.
  std::vector<std::pair<float, std::uint32_t>> near;
  grid.for_each_near(vertex, [&](std::uint32_t anchor, float distance_m) {
    near.emplace_back(distance_m, anchor);
  });
  const std::size_t count = std::min(near.size(), kMostBlended);
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
  // Weigh them.
  AnchorBlend blend;
  float sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float left = 1.0f - near[i].first / (kReach * spacing_m);
    blend.anchor[i] = near[i].second;
    blend.weight[i] = left * left;
    sum += blend.weight[i];
  }
  if (!(sum > 0.0f)) return {};
  for (float& weight : blend.weight) weight /= sum;
  return blend;
}

}  // namespace

std::vector<std::uint32_t> scatter_anchors(const core::Mesh& mesh, float spacing_m) {
  assert(spacing_m > 0.0f);
  AnchorGrid grid(mesh, spacing_m);
  std::vector<std::uint32_t> anchors;
  for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    if (grid.add(vertex)) anchors.push_back(vertex);
  }
  return anchors;
}

bool are_scattered(const core::Mesh& mesh, std::span<const std::uint32_t> anchors,
                   float spacing_m) {
  AnchorGrid grid(mesh, spacing_m);
  std::size_t next = 0;
  for (const std::uint32_t vertex : anchors) {
    if (vertex < next || vertex >= mesh.positions.size() || !grid.add(vertex)) return false;
    next = std::size_t{vertex} + 1;
  }
  return true;
}

std::vector<AnchorBlend> blend_anchors(const core::Mesh& mesh,
                                       std::span<const std::uint32_t> anchors, float spacing_m) {
  AnchorGrid grid(mesh, spacing_m);
  for (const std::uint32_t vertex : anchors) grid.add(vertex);
  std::vector<AnchorBlend> blends(mesh.positions.size());
  for (std::uint32_t vertex = 0; vertex < blends.size(); ++vertex) {
    blends[vertex] = blend_at(grid, vertex, spacing_m);
  }
  return blends;
}

}  // namespace sheen::fitting::detail
