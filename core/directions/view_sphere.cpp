// SPDX-License-Identifier: MIT
#include "core/directions/view_sphere.h"

#include "core/directions/convex_hull.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace sheen::core {
namespace {

/// Distance of a face from the centre: the cosine of its circle's angle.
constexpr double kLeastHeight = 0.5;
/// Weights so little below zero are rounding.
constexpr double kRounding = 1e-9;

double height_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double length = normal.norm();
  return length > 0 ? std::abs(normal.dot(a)) / length : 0;
}

/// Where on the arc from a to b a direction comes nearest to it: weights of both and the cosine.
struct NearestOnArc {
  double at_a, at_b, cosine;
};
NearestOnArc nearest_on_arc(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& direction) {
  const double along = a.dot(b);
  const double to_a = a.dot(direction), to_b = b.dot(direction);
  const double determinant = 1 - along * along;
  // The projection onto the arc's plane as at_a a + at_b b.
  double at_a = to_a >= to_b ? 1 : 0;
  double at_b = 1 - at_a;
  if (determinant > kRounding) {
    const double first = (to_a - along * to_b) / determinant;
    const double second = (to_b - along * to_a) / determinant;
    if (first > 0 && second > 0) {
      at_a = first / (first + second);
      at_b = 1 - at_a;
    }
  }
  const Eigen::Vector3d place = at_a * a + at_b * b;
  return {at_a, at_b, place.dot(direction) / place.norm()};
}

}  // namespace

ViewSphere::ViewSphere(std::vector<Eigen::Vector3d> directions)
    : directions_(std::move(directions)) {
  // With the centre as one more point the hull of directions on one side has their rim, too.
  std::vector<Eigen::Vector3d> points = directions_;
  points.push_back(Eigen::Vector3d::Zero());
  if (const auto faces = convex_hull(points)) {
    keep_faces(*faces);
  } else {
    join_in_a_ring();
  }
}

void ViewSphere::keep_faces(const std::vector<Triangle>& faces) {
  const auto centre = static_cast<std::uint32_t>(directions_.size());
  std::map<Edge, bool> is_border;
  for (const Triangle& face : faces) {
    bool kept = std::ranges::find(face, centre) == face.end();
    if (kept) {
      Eigen::Matrix3d corners;
      for (int i = 0; i < 3; ++i) corners.col(i) = directions_[face[static_cast<std::size_t>(i)]];
      kept = height_of(corners.col(0), corners.col(1), corners.col(2)) >= kLeastHeight &&
             std::abs(corners.determinant()) > std::numeric_limits<double>::min();
      if (kept) {
        triangles_.push_back(face);
        barycentric_.emplace_back(corners.inverse());
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      Edge edge{face[i], face[(i + 1) % 3]};
      std::ranges::sort(edge);
      if (edge[1] == centre) continue;
      is_border[edge] = is_border[edge] || !kept;
    }
  }
  for (const auto& [edge, border] : is_border) {
    if (border) borders_.push_back(edge);
  }
}

/// Directions of one plane, or fewer than three: each is joined to the next one round about.
void ViewSphere::join_in_a_ring() {
  if (directions_.empty()) return;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& one : directions_) spread += one * one.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  std::vector<double> angle;
  for (const Eigen::Vector3d& one : directions_) {
    angle.push_back(
        std::atan2(one.dot(axes.eigenvectors().col(1)), one.dot(axes.eigenvectors().col(2))));
  }
  std::vector<std::uint32_t> order(directions_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return angle[i]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t here = order[i], next = order[(i + 1) % order.size()];
    const double turn = angle[next] - angle[here] + (i + 1 == order.size() ? 2 * M_PI : 0);
    borders_.push_back({here, turn < M_PI ? next : here});
  }
}

SphereBlend ViewSphere::blend(const Eigen::Vector3d& direction) const {
  assert(!directions_.empty());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Eigen::Vector3d weights = barycentric_[t] * direction;
    if (!(weights.minCoeff() >= -kRounding)) continue;
    const Eigen::Vector3d positive = weights.cwiseMax(0.0);
    const Eigen::Vector3f sum_1 = (positive / positive.sum()).cast<float>();
    return {triangles_[t], {sum_1[0], sum_1[1], sum_1[2]}};
  }
  SphereBlend nearest;
  double best = -std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : borders_) {
    const NearestOnArc place = nearest_on_arc(directions_[a], directions_[b], direction);
    if (!(place.cosine > best)) continue;
    best = place.cosine;
    nearest = {{a, b, a}, {static_cast<float>(place.at_a), static_cast<float>(place.at_b), 0.0f}};
  }
  return nearest;
}

}  // namespace sheen::core
