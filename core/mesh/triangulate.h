// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::core {

/// Cuts the polygons of one mesh file into triangles. A polygon all of which its first corner sees
/// (every convex one) becomes a fan round that corner, another is cut ear by ear in the plane that
/// fits it best. Outlines that cross themselves are cut as far as they have ears, the rest is a
/// fan.
class Triangulator {
 public:
  using Triangle = Eigen::Matrix<std::uint32_t, 3, 1>;

  /// Appends the triangles of one polygon, wound as it is; fewer than three corners give none.
  /// `corners` index `positions`. False, with nothing appended, when the file's polygons ask for
  /// more work than any honest file does.
  [[nodiscard]] bool cut(std::span<const std::uint32_t> corners,
                         const std::vector<Eigen::Vector3d>& positions,
                         std::vector<Triangle>& triangles);

  /// Polygons so far whose outline crosses itself.
  [[nodiscard]] std::size_t crossing() const { return crossing_; }

 private:
  bool cut_ears(std::span<const std::uint32_t> corners,
                const std::vector<Eigen::Vector3d>& positions, const Eigen::Vector3d& normal,
                std::vector<Triangle>& triangles);

  std::vector<Eigen::Vector2d> flat_;    ///< the polygon in its plane
  std::vector<std::uint32_t> left_;      ///< corners not cut off yet, by place in the outline
  std::vector<std::uint8_t> is_reflex_;  ///< by place in the outline
  std::size_t crossing_ = 0;
  std::uint64_t work_ = 0;  ///< corners compared with ears
};

}  // namespace sheen::core
