// SPDX-License-Identifier: MIT
#include "core/atlas/coverage.h"

#include <algorithm>
#include <cmath>

namespace sheen::core {
namespace {

/// Heights may differ by so much within a texel: the steepest triangle rises by 4 per texel, and a
/// touched texel's centre may lie a texel outside the triangle.
constexpr float kTolerance = 10.0f;
/// Centres nearer than this to a side belong to nobody: neighbours share their sides.
constexpr float kSide = 1e-3f;
/// Margin of touched texels around a triangle.
constexpr float kMargin = 1.0f;

}  // namespace

Coverage::Coverage(const Eigen::AlignedBox2f& bounds)
    : origin_((bounds.min().array() - 2.0f).floor()),
      width_(static_cast<std::int32_t>(std::ceil(bounds.max().x() - origin_.x())) + 2),
      height_(static_cast<std::int32_t>(std::ceil(bounds.max().y() - origin_.y())) + 2),
      texels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

template <typename Visit>
void Coverage::for_each(const FlatTriangle& triangle, const Visit& visit) {
  // Sides as distances, positive inside; the plane of the heights.
  const Eigen::Vector2f a = triangle[0].head<2>() - origin_;
  const Eigen::Vector2f b = triangle[1].head<2>() - origin_;
  const Eigen::Vector2f c = triangle[2].head<2>() - origin_;
  const Eigen::Vector2f ab = b - a;
  const Eigen::Vector2f ac = c - a;
  const float area = ab.x() * ac.y() - ab.y() * ac.x();
  if (!(area > 1e-6f)) return;
  const std::array<Eigen::Vector2f, 3> corner{a, b, c};
  std::array<Eigen::Vector3f, 3> side;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector2f along = corner[(i + 1) % 3] - corner[i];
    const Eigen::Vector2f inwards = Eigen::Vector2f(-along.y(), along.x()) / along.norm();
    side[i] = {inwards.x(), inwards.y(), -inwards.dot(corner[i])};
  }
  const float rise_b = triangle[1].z() - triangle[0].z();
  const float rise_c = triangle[2].z() - triangle[0].z();
  const float slope_x = (rise_b * ac.y() - rise_c * ab.y()) / area;
  const float slope_y = (rise_c * ab.x() - rise_b * ac.x()) / area;

  // Visit the centres around.
  const Eigen::Array2f least = a.cwiseMin(b).cwiseMin(c).array() - kMargin;
  const Eigen::Array2f most = a.cwiseMax(b).cwiseMax(c).array() + kMargin;
  const auto first = [](float x) { return static_cast<std::int32_t>(std::ceil(x - 0.5f)); };
  const auto last = [](float x) { return static_cast<std::int32_t>(std::floor(x - 0.5f)); };
  const std::int32_t end_x = std::min(last(most.x()), width_ - 1);
  const std::int32_t end_y = std::min(last(most.y()), height_ - 1);
  for (std::int32_t y = std::max(0, first(least.y())); y <= end_y; ++y) {
    for (std::int32_t x = std::max(0, first(least.x())); x <= end_x; ++x) {
      const Eigen::Vector2f at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      float inside = 1e9f;
      for (const Eigen::Vector3f& s : side) inside = std::min(inside, s.dot(at.homogeneous()));
      if (inside < -kMargin) continue;
      const float height =
          triangle[0].z() + slope_x * (at.x() - a.x()) + slope_y * (at.y() - a.y());
      visit(texels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x)],
            height, inside > kSide);
    }
  }
}

bool Coverage::add(const FlatTriangle& triangle) {
  bool fits = true;
  for_each(triangle, [&](const Texel& texel, float height, bool covered) {
    const bool twice = covered && texel.covered;
    const bool far = texel.touched && std::abs(texel.height - height) > kTolerance;
    if (twice || far) fits = false;
  });
  if (!fits) return false;
  for_each(triangle, [](Texel& texel, float height, bool covered) {
    if (!texel.touched || covered) texel.height = height;
    texel.touched = true;
    texel.covered = texel.covered || covered;
  });
  return true;
}

}  // namespace sheen::core
