// SPDX-License-Identifier: MIT
#include "fitting/detail/asked_cells.h"

#include "fitting/detail/patch_kernels.h"
#include "fitting/sparse/columns.h"

#include <algorithm>
#include <array>
#include <bitset>

namespace sheen::fitting::detail {
namespace {

/// Cells along a side of grids over the disc of directions, fine to coarse.
constexpr std::array<int, 9> kGrids{40, 30, 22, 16, 13, 11, 8, 5, 2};
constexpr std::size_t kMostCells = std::size_t{kGrids[0]} * kGrids[0];

std::size_t cell_at(const Eigen::Vector2f& uv, int grid) {
  const auto along = [&](float x) {
    return std::clamp(static_cast<int>(0.5f * (x + 1.0f) * static_cast<float>(grid)), 0, grid - 1);
  };
  return static_cast<std::size_t>(along(uv.y()) * grid + along(uv.x()));
}

/// The finest of which directions touch no more than `most` (>= 4) cells.
int grid_for(std::span<const Eigen::Vector2f> directions, std::size_t most) {
  for (const int grid : kGrids) {
    std::bitset<kMostCells> touched;
    for (const Eigen::Vector2f& uv : directions) touched.set(cell_at(uv, grid));
    if (touched.count() <= most) return grid;
  }
  return kGrids.back();
}

/// As the anchor is asked for the followers' samples, on its disc.
std::vector<Eigen::Vector2f> asked(const AnchoredOffsets& anchors, std::size_t anchor,
                                   std::span<const Follower> followers,
                                   const AnchorResiduals& residuals) {
  std::vector<Eigen::Vector2f> uvs;
  sparse::Column u, v;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
  for (const Follower& follower : followers) {
    const DirectionRows w = residuals.of(follower.triangle).w;
    asked_directions(anchors.asked_patch(anchor, follower.normal), w, u.row, v.row);
    for (std::size_t row = 0; row < w.count; ++row) uvs.emplace_back(u.row[row], v.row[row]);
  }
  return uvs;
}

/// What lies near an anchor is its own.
float weight_of(const Follower& follower) {
  return follower.weight * follower.weight;
}

}  // namespace

AskedCells::AskedCells(const AnchoredOffsets& anchors, std::size_t anchor,
                       std::span<const Follower> followers, const AnchorResiduals& residuals,
                       std::size_t most) {
  const std::vector<Eigen::Vector2f> uvs = asked(anchors, anchor, followers, residuals);
  number(uvs, grid_for(uvs, most));
  std::size_t next = 0;
  for (const Follower& follower : followers) {
    const AnchorResiduals::Rows rows = residuals.of(follower.triangle);
    for (std::size_t row = 0; row < rows.w.count; ++row, ++next) {
      Cell& cell = cells_[of_sample_[next]];
      const float weight = weight_of(follower) * rows.weight[row];
      cell.weight += weight;
      cell.uv += weight * uvs[next];
    }
  }
  for (Cell& cell : cells_) {
    if (cell.weight > 0.0f) cell.uv /= cell.weight;
  }
}

/// Those of the grid's cells that are asked, in its order.
void AskedCells::number(std::span<const Eigen::Vector2f> uvs, int grid) {
  std::array<std::uint8_t, kMostCells> number{};
  for (const Eigen::Vector2f& uv : uvs) number[cell_at(uv, grid)] = 1;
  std::uint8_t next = 0;
  for (std::uint8_t& of_cell : number) {
    if (of_cell != 0) of_cell = next++;
  }
  cells_.resize(next);
  of_sample_.reserve(uvs.size());
  for (const Eigen::Vector2f& uv : uvs) of_sample_.push_back(number[cell_at(uv, grid)]);
}

std::span<const sparse::DirectedColour> AskedCells::read(
    const AnchoredOffsets& anchors, std::size_t anchor, std::span<const Follower> followers,
    const AnchorResiduals& residuals, std::span<sparse::DirectedColour> samples) const {
  std::array<Eigen::Vector3f, sparse::kMaxStoredSamples> left;
  std::fill_n(left.begin(), cells_.size(), Eigen::Vector3f::Zero());
  const std::uint8_t* cell = of_sample_.data();
  for (const Follower& follower : followers) {
    const auto& [w, weight, of] = residuals.of(follower.triangle);
    for (std::size_t row = 0; row < w.count; ++row) {
      left[*cell++] +=
          weight_of(follower) * weight[row] * Eigen::Vector3f(of[0][row], of[1][row], of[2][row]);
    }
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const auto& [weight, uv] = cells_[i];
    if (!(weight > 0.0f)) continue;
    samples[count++] = {uv, anchors.models().colour(anchor, uv) + left[i] / weight};
  }
  return samples.first(count);
}

}  // namespace sheen::fitting::detail
