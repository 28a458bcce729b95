// SPDX-License-Identifier: MIT
#include "core/atlas/chart.h"

#include "core/atlas/coverage.h"
#include "core/atlas/flattening.h"
#include "core/atlas/triangle_shapes.h"
#include "core/mesh/triangle_neighbours.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sheen::core {
namespace {

using Sides = std::array<std::uint32_t, 3>;

/// What a boundary costs, in texels of surface per texel of its length: both sides need a margin.
constexpr float kBoundaryTexels = 4.0f;

/// Plane of a projection: two axes in it and the one along which is looked, in texels per metre.
struct Plane {
  Eigen::Matrix3f axes;  ///< rows: x, y, towards the eye

  [[nodiscard]] Eigen::Vector3f operator()(const Eigen::Vector3f& point) const {
    return axes * point;
  }
};

/// Takes charts out of a mesh one after the other.
class ChartMaker {
 public:
  ChartMaker(const Mesh& mesh, float texel_m)
      : mesh_(mesh),
        texel_m_(texel_m),
        shapes_(triangle_shapes(mesh)),
        neighbours_(triangle_neighbours(mesh)),
        flat_(flatten(mesh, shapes_, neighbours_, kBoundaryTexels * texel_m)),
        region_(mesh.triangles.size(), 0),
        taken_(mesh.triangles.size(), 0) {}

  std::vector<Chart> make() {
    std::vector<Chart> charts;
    for (std::uint32_t seed = 0; seed < taken_.size(); ++seed) {
      // What does not fit into a chart with the seed is met again as a later seed.
      if (taken_[seed] == 0) charts.push_back(grow(seed, region_of(seed)));
    }
    return charts;
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> region_of(std::uint32_t seed);
  [[nodiscard]] Eigen::Vector3f direction_of(const std::vector<std::uint32_t>& region) const;
  [[nodiscard]] Plane plane_of(const std::vector<std::uint32_t>& region) const;
  [[nodiscard]] Chart grow(std::uint32_t seed, const std::vector<std::uint32_t>& region);

  [[nodiscard]] FlatTriangle project(const Plane& plane, std::uint32_t t) const {
    const auto& triangle = mesh_.triangles[t];
    return {plane(mesh_.positions[triangle[0]]), plane(mesh_.positions[triangle[1]]),
            plane(mesh_.positions[triangle[2]])};
  }
  [[nodiscard]] bool faces(std::uint32_t t, const Eigen::Vector3f& direction) const {
    return !(shapes_.area_m2[t] > 0.0f) ||
           shapes_.normal[t].dot(direction) >= kLeastFlatteningCosine;
  }

  const Mesh& mesh_;
  float texel_m_;
  TriangleShapes shapes_;
  std::vector<Sides> neighbours_;
  Flattening flat_;
  std::vector<std::uint32_t> region_;  ///< number of the region that a triangle was last in
  std::uint32_t regions_ = 0;
  std::vector<std::uint8_t> taken_;
};

/// Connected triangles of one direction that no chart has yet.
std::vector<std::uint32_t> ChartMaker::region_of(std::uint32_t seed) {
  ++regions_;
  std::vector<std::uint32_t> region{seed};
  region_[seed] = regions_;
  for (std::size_t head = 0; head < region.size(); ++head) {
    for (const std::uint32_t other : neighbours_[region[head]]) {
      if (other == kNoTriangle || taken_[other] != 0 || region_[other] == regions_) continue;
      if (flat_.of_triangle[other] != flat_.of_triangle[seed]) continue;
      region_[other] = regions_;
      region.push_back(other);
    }
  }
  return region;
}

/// The mean normal where all triangles may be projected along it, else the region's common
/// direction, else the seed's normal.
Eigen::Vector3f ChartMaker::direction_of(const std::vector<std::uint32_t>& region) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const std::uint32_t t : region) sum += shapes_.area_m2[t] * shapes_.normal[t];
  const float length = sum.norm();
  if (length > 0.0f) {
    const Eigen::Vector3f mean = sum / length;
    if (std::ranges::all_of(region, [&](std::uint32_t t) { return faces(t, mean); })) return mean;
  }
  const Eigen::Vector3f& common = flat_.directions[flat_.of_triangle[region.front()]];
  return faces(region.front(), common) ? common : shapes_.normal[region.front()];
}

/// Turned so that the region's rectangle is small and lies along the axes.
Plane ChartMaker::plane_of(const std::vector<std::uint32_t>& region) const {
  const Eigen::Vector3f direction = direction_of(region);
  const Eigen::Vector3f across = direction.unitOrthogonal();
  Plane plane;
  plane.axes << across.transpose(), direction.cross(across).transpose(), direction.transpose();

  // Turn.
  std::vector<cv::Point2f> points;
  points.reserve(3 * region.size());
  float surface = 0;
  float projected = 0;
  for (const std::uint32_t t : region) {
    if (!faces(t, direction)) continue;
    surface += shapes_.area_m2[t];
    projected += shapes_.area_m2[t] * shapes_.normal[t].dot(direction);
    for (const std::uint32_t vertex : mesh_.triangles[t]) {
      const Eigen::Vector3f p = plane(mesh_.positions[vertex]) / texel_m_;
      points.emplace_back(p.x(), p.y());
    }
  }
  const cv::RotatedRect box = cv::minAreaRect(points);
  const bool upright = box.size.width < box.size.height;
  const float angle = (box.angle + (upright ? 90.0f : 0.0f)) * static_cast<float>(CV_PI / 180);
  Eigen::Matrix3f turn = Eigen::Matrix3f::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);

  // Scale.
  const float enlarged = projected > 0.0f ? std::sqrt(surface / projected) : 1.0f;
  plane.axes = (turn * plane.axes).eval() * (enlarged / texel_m_);
  return plane;
}

/// The part of the region that can be reached from the seed without folding over.
Chart ChartMaker::grow(std::uint32_t seed, const std::vector<std::uint32_t>& region) {
  const Plane plane = plane_of(region);
  const Eigen::Vector3f direction = plane.axes.row(2).transpose().normalized();
  Eigen::AlignedBox2f bounds;
  for (const std::uint32_t t : region) {
    for (const Eigen::Vector3f& corner : project(plane, t)) bounds.extend(corner.head<2>());
  }
  Coverage coverage(bounds);

  // Spread across sides.
  Chart chart;
  std::vector<std::uint32_t> queue{seed};
  region_[seed] = 0;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::uint32_t t = queue[head];
    const bool fits = faces(t, direction) && coverage.add(project(plane, t));
    if (!fits && t != seed) continue;
    taken_[t] = 1;
    chart.triangles.push_back(t);
    for (const std::uint32_t other : neighbours_[t]) {
      if (other == kNoTriangle || region_[other] != regions_) continue;
      region_[other] = 0;
      queue.push_back(other);
    }
  }

  // Move the chart to the origin by whole texels: which texels it covers stays.
  std::sort(chart.triangles.begin(), chart.triangles.end());
  Eigen::AlignedBox2f taken;
  for (const std::uint32_t t : chart.triangles) {
    const FlatTriangle flat = project(plane, t);
    chart.corners.push_back({flat[0].head<2>(), flat[1].head<2>(), flat[2].head<2>()});
    for (const Eigen::Vector2f& corner : chart.corners.back()) taken.extend(corner);
  }
  const Eigen::Vector2f origin = taken.min().array().floor();
  for (auto& corners : chart.corners) {
    for (Eigen::Vector2f& corner : corners) corner -= origin;
  }
  chart.size = taken.max() - origin;
  return chart;
}

}  // namespace

std::vector<Chart> make_charts(const Mesh& mesh, float texel_m) {
  return ChartMaker(mesh, texel_m).make();
}

}  // namespace sheen::core
