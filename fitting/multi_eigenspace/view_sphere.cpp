// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/view_sphere.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace sheen::fitting::multi_eigenspace {
namespace {

/// The direction that is farthest from all views, to a few degrees.
Eigen::Vector3d farthest_from(const std::vector<Eigen::Vector3d>& directions) {
  constexpr int candidates = 1000;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  Eigen::Vector3d farthest = -directions.front();
  double least_cosine = 2;
  for (int i = 0; i < candidates; ++i) {
    const double z = 1 - (2 * i + 1.0) / candidates;
    const double across = std::sqrt(1 - z * z);
    const Eigen::Vector3d one(across * std::cos(golden * i), across * std::sin(golden * i), z);
    double nearest_cosine = -2;
    for (const auto& direction : directions) {
      nearest_cosine = std::max(nearest_cosine, direction.dot(one));
    }
    if (nearest_cosine >= least_cosine) continue;
    least_cosine = nearest_cosine;
    farthest = one;
  }
  return farthest;
}

/// Stereographic images, from `pole`. Circles stay circles, so the triangles of the plane are those
/// of the sphere. Scaled to at most `reach`.
std::vector<cv::Point2f> in_plane(const std::vector<Eigen::Vector3d>& directions,
                                  const Eigen::Vector3d& pole, double reach) {
  const Eigen::Vector3d x = pole.unitOrthogonal();
  const Eigen::Vector3d y = pole.cross(x);
  std::vector<Eigen::Vector2d> points;
  double farthest = 0;
  for (const auto& direction : directions) {
    points.emplace_back(Eigen::Vector2d(direction.dot(x), direction.dot(y)) /
                        std::max(1 - direction.dot(pole), 1e-9));
    farthest = std::max(farthest, points.back().norm());
  }
  const double scale = farthest > 0 ? reach / farthest : 1;
  std::vector<cv::Point2f> scaled;
  for (const auto& point : points) {
    scaled.emplace_back(static_cast<float>(scale * point.x()),
                        static_cast<float>(scale * point.y()));
  }
  return scaled;
}

/// Views by where they lie in the plane.
class PlaceIndex {
 public:
  explicit PlaceIndex(const std::vector<cv::Point2f>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      idx_.try_emplace({points[i].x, points[i].y}, static_cast<std::uint32_t>(i));
    }
  }
  /// -1: none of them.
  [[nodiscard]] std::int64_t find(float x, float y) const {
    const auto found = idx_.find({x, y});
    return found == idx_.end() ? -1 : std::int64_t{found->second};
  }

 private:
  std::map<std::pair<float, float>, std::uint32_t> idx_;
};

}  // namespace

ViewSphere::ViewSphere(std::vector<Eigen::Vector3d> directions)
    : directions_(std::move(directions)),
      neighbours_(directions_.size()),
      mixed_with_(directions_.size()) {
  if (directions_.size() > 1) triangulate();
  for (const auto& [a, b] : edges_) {
    mixed_with_[a].push_back(b);
    mixed_with_[b].push_back(a);
  }
  for (const Edge& edge : edges_) {
    if (has_view_between(edge)) continue;
    neighbours_[edge[0]].push_back(edge[1]);
    neighbours_[edge[1]].push_back(edge[0]);
  }
  for (std::size_t i = 0; i < neighbours_.size(); ++i) {
    std::ranges::sort(neighbours_[i], [&](std::uint32_t a, std::uint32_t b) {
      const double near = directions_[a].dot(directions_[i]);
      const double far = directions_[b].dot(directions_[i]);
      return near != far ? near > far : a < b;
    });
  }
}

/// Within the circle that has the edge as its diameter. If there is one, then also a neighbour of
/// an end.
bool ViewSphere::has_view_between(const Edge& edge) const {
  const Eigen::Vector3d middle = directions_[edge[0]] + directions_[edge[1]];
  const auto is_between = [&](std::uint32_t view) {
    constexpr double rounding = 1e-9;
    return view != edge[0] && view != edge[1] &&
           directions_[view].dot(middle) > directions_[edge[0]].dot(middle) + rounding;
  };
  return std::ranges::any_of(mixed_with_[edge[0]], is_between) ||
         std::ranges::any_of(mixed_with_[edge[1]], is_between);
}

void ViewSphere::triangulate() {
  // The triangulation's own outermost corners lie three times as far as its border; the views are
  // small within it, so that hardly any edge of their hull is lost to those.
  constexpr int border = 100000;
  constexpr double reach = 1000;
  const auto points = in_plane(directions_, farthest_from(directions_), reach);
  const PlaceIndex index(points);
  cv::Subdiv2D plane(cv::Rect(-border, -border, 2 * border, 2 * border));
  for (std::size_t i = 0; i < points.size(); ++i) {
    plane.insert(points[i]);
    const auto first = static_cast<std::uint32_t>(index.find(points[i].x, points[i].y));
    if (first != i) edges_.push_back({first, static_cast<std::uint32_t>(i)});
  }

  std::vector<cv::Vec4f> edges;
  plane.getEdgeList(edges);
  for (const auto& edge : edges) {
    const std::int64_t a = index.find(edge[0], edge[1]);
    const std::int64_t b = index.find(edge[2], edge[3]);
    if (a < 0 || b < 0 || a == b) continue;
    edges_.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
  }
  std::vector<cv::Vec6f> triangles;
  plane.getTriangleList(triangles);
  for (const auto& triangle : triangles) {
    std::array<std::uint32_t, 3> corners{};
    bool known = true;
    for (int c = 0; c < 3; ++c) {
      const std::int64_t i = index.find(triangle[2 * c], triangle[2 * c + 1]);
      known = known && i >= 0;
      if (known) corners[static_cast<std::size_t>(c)] = static_cast<std::uint32_t>(i);
    }
    if (known) add_triangle(corners);
  }
}

void ViewSphere::add_triangle(const std::array<std::uint32_t, 3>& corners) {
  Eigen::Matrix3d direction_from_shares;
  for (int c = 0; c < 3; ++c) {
    direction_from_shares.col(c) = directions_[corners[static_cast<std::size_t>(c)]];
  }
  // Three directions in one plane hold nothing between them that an edge does not.
  constexpr double flat = 1e-12;
  if (!(std::abs(direction_from_shares.determinant()) > flat)) return;
  triangles_.push_back({corners, direction_from_shares.inverse()});
}

std::vector<ViewShare> ViewSphere::shares(const Eigen::Vector3d& direction) const {
  for (const auto& [corners, shares_from_direction] : triangles_) {
    const Eigen::Vector3d shares = shares_from_direction * direction;
    if (!(shares.minCoeff() >= 0)) continue;
    std::vector<ViewShare> all;
    for (int c = 0; c < 3; ++c) {
      all.push_back(
          {corners[static_cast<std::size_t>(c)], static_cast<float>(shares[c] / shares.sum())});
    }
    return all;
  }
  if (directions_.empty()) return {};
  std::vector<ViewShare> nearest{{0, 1.0f}};
  double greatest_cosine = -2;
  for (const auto& [a, b] : edges_) {
    // The nearest point of the arc: least squares in its plane, held between its ends.
    const double between = directions_[a].dot(directions_[b]);
    const double to_a = directions_[a].dot(direction);
    const double to_b = directions_[b].dot(direction);
    double share_a = std::max(to_a - between * to_b, 0.0);
    double share_b = std::max(to_b - between * to_a, 0.0);
    if (!(share_a + share_b > 0)) (to_a >= to_b ? share_a : share_b) = 1;
    const Eigen::Vector3d on_arc = share_a * directions_[a] + share_b * directions_[b];
    const double cosine = on_arc.dot(direction) / on_arc.norm();
    if (!(cosine > greatest_cosine)) continue;
    greatest_cosine = cosine;
    const auto part = static_cast<float>(share_b / (share_a + share_b));
    nearest = {{a, 1.0f - part}, {b, part}};
  }
  return nearest;
}

}  // namespace sheen::fitting::multi_eigenspace
