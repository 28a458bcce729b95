// SPDX-License-Identifier: MIT
#include "core/mesh/triangulate.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>

namespace sheen::core {
namespace {

constexpr std::uint64_t kMostWork = 2'000'000'000;  // some seconds

/// Twice the area along the normal, by Newell's sum: of any polygon, plane or not.
Eigen::Vector3d doubled_area(std::span<const std::uint32_t> corners,
                             const std::vector<Eigen::Vector3d>& positions) {
  const Eigen::Vector3d& origin = positions[corners[0]];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    sum += (positions[corners[i - 1]] - origin).cross(positions[corners[i]] - origin);
  }
  return sum;
}

/// Whether no triangle of the fan round the first corner is turned against the polygon.
bool is_fan(std::span<const std::uint32_t> corners, const std::vector<Eigen::Vector3d>& positions,
            const Eigen::Vector3d& normal) {
  const Eigen::Vector3d& apex = positions[corners[0]];
  const double rounding = 1e-9 * normal.squaredNorm();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Eigen::Vector3d area =
        (positions[corners[i - 1]] - apex).cross(positions[corners[i]] - apex);
    if (area.dot(normal) < -rounding) return false;
  }
  return true;
}

void append_fan(std::span<const std::uint32_t> corners,
                std::vector<Triangulator::Triangle>& triangles) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
  }
}

/// Twice the area of the triangle, positive when it turns left.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Whether `p` lies in the triangle or on its rim. A corner in the same place does not count:
/// outlines with a hole touch themselves along a bridge.
bool holds(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
           const Eigen::Vector2d& p) {
  if (p == a || p == b || p == c) return false;
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

}  // namespace

bool Triangulator::cut(std::span<const std::uint32_t> corners,
                       const std::vector<Eigen::Vector3d>& positions,
                       std::vector<Triangle>& triangles) {
  if (corners.size() <= 3) {
    append_fan(corners, triangles);
    return true;
  }
  const Eigen::Vector3d normal = doubled_area(corners, positions);
  // Without an area, or with corners that are no numbers, there is no plane to cut in.
  if (!(normal.squaredNorm() > 0) || is_fan(corners, positions, normal)) {
    append_fan(corners, triangles);
    return true;
  }
  return cut_ears(corners, positions, normal, triangles);
}

bool Triangulator::cut_ears(std::span<const std::uint32_t> corners,
                            const std::vector<Eigen::Vector3d>& positions,
                            const Eigen::Vector3d& normal, std::vector<Triangle>& triangles) {
  // Lay the polygon flat, counter-clockwise.
  const Eigen::Vector3d across = normal.unitOrthogonal();
  const Eigen::Vector3d up = normal.normalized().cross(across);
  flat_.clear();
  for (const std::uint32_t corner : corners) {
    const Eigen::Vector3d from_first = positions[corner] - positions[corners[0]];
    flat_.emplace_back(from_first.dot(across), from_first.dot(up));
  }
  left_.resize(corners.size());
  std::iota(left_.begin(), left_.end(), 0U);
  const auto turn_at = [this](std::size_t i) {
    const std::size_t n = left_.size();
    return turn(flat_[left_[(i + n - 1) % n]], flat_[left_[i]], flat_[left_[(i + 1) % n]]);
  };
  is_reflex_.assign(corners.size(), 0);
  for (std::size_t i = 0; i < left_.size(); ++i) is_reflex_[i] = turn_at(i) < 0;

  // Cut ear after ear off: a corner that turns left and holds no other of the outline, which could
  // only be one that turns right.
  const std::size_t first_triangle = triangles.size();
  std::size_t i = 0;
  std::size_t looked_at = 0;
  while (left_.size() > 3) {
    const std::size_t n = left_.size();
    i %= n;
    const std::uint32_t before = left_[(i + n - 1) % n], here = left_[i],
                        after = left_[(i + 1) % n];
    const double area = turn_at(i);
    work_ += n;
    if (work_ > kMostWork) {
      triangles.resize(first_triangle);
      return false;
    }
    const bool is_ear =
        area > 0 && std::none_of(left_.begin(), left_.end(), [&](std::uint32_t other) {
          return is_reflex_[other] != 0 && other != before && other != after &&
                 holds(flat_[before], flat_[here], flat_[after], flat_[other]);
        });
    // A corner on the line between its neighbours goes without a triangle that covers anything.
    if (!is_ear && !(area == 0 && looked_at >= n)) {
      if (++looked_at > 2 * n) break;  // no ear left: the outline crosses itself
      ++i;
      continue;
    }
    triangles.emplace_back(corners[before], corners[here], corners[after]);
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i));
    looked_at = 0;
    for (const std::size_t neighbour : {i + n - 2, i}) {
      const std::size_t place = neighbour % (n - 1);
      is_reflex_[left_[place]] = turn_at(place) < 0;
    }
    ++i;  // not the next one: fans of slivers are avoided
  }
  if (left_.size() > 3) ++crossing_;
  for (std::size_t k = 2; k < left_.size(); ++k) {
    triangles.emplace_back(corners[left_[0]], corners[left_[k - 1]], corners[left_[k]]);
  }
  return true;
}

}  // namespace sheen::core
