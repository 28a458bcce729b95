// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::core {

/// A triangle projected onto a plane: x, y and the height above it, texels.
using FlatTriangle = std::array<Eigen::Vector3f, 3>;

/// Which texels of a chart are covered, and how high the surface lies there: tells whether another
/// triangle would fold over what is there.
class Coverage {
 public:
  /// For triangles within `bounds`, texels.
  explicit Coverage(const Eigen::AlignedBox2f& bounds);

  /// Adds a triangle (counter-clockwise), unless it covers a centre of a texel that another one
  /// covers, or comes within a texel of a part of the surface that lies far above or below it.
  /// Lines and points always fit.
  bool add(const FlatTriangle& triangle);

 private:
  struct Texel {
    float height = 0;
    bool touched = false;  ///< within a texel of a triangle: `height` holds
    bool covered = false;  ///< its centre lies in a triangle
  };

  /// Calls `visit(texel, height, covered)` for all texels within one of the triangle.
  template <typename Visit>
  void for_each(const FlatTriangle& triangle, const Visit& visit);

  Eigen::Vector2f origin_;
  std::int32_t width_, height_;
  std::vector<Texel> texels_;
};

}  // namespace sheen::core
