// SPDX-License-Identifier: MIT
#include "capture/synthetic/torus_knot.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

namespace sheen::capture::synthetic {
namespace {

constexpr double kRingRadius = 0.0425;    // of the torus' core circle
constexpr double kSectionRadius = 0.020;  // of the torus' cross section, across
constexpr double kSectionHeight = 0.025;  // and up
constexpr double kTubeRadius = 0.0125;

/// Point of the knot with the frame its tube is built in.
struct CurvePoint {
  Eigen::Vector3d position, tangent, normal;
};

CurvePoint knot_at(double t) {
  const Eigen::Vector3d outward(std::cos(2 * t), std::sin(2 * t), 0);
  const Eigen::Vector3d around(-std::sin(2 * t), std::cos(2 * t), 0);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const double c = std::cos(3 * t);
  const double s = std::sin(3 * t);
  const double radius = kRingRadius + kSectionRadius * c;

  // The knot lies on a torus of elliptic section; the torus' normal is orthogonal to the knot and
  // returns to itself after one round, which Frenet's would do only by luck.
  return {radius * outward + kSectionHeight * s * up,
          (-3 * kSectionRadius * s * outward + 2 * radius * around + 3 * kSectionHeight * c * up)
              .normalized(),
          (c / kSectionRadius * outward + s / kSectionHeight * up).normalized()};
}

/// Length of the knot up to each of the equal steps of its parameter.
std::vector<double> cumulative_lengths() {
  constexpr int steps = 8192;
  std::vector<double> lengths{0};
  lengths.reserve(steps + 1);
  Eigen::Vector3d previous = knot_at(0).position;
  for (int i = 1; i <= steps; ++i) {
    const Eigen::Vector3d current = knot_at(2 * std::numbers::pi * i / steps).position;
    lengths.push_back(lengths.back() + (current - previous).norm());
    previous = current;
  }
  return lengths;
}

/// Parameter at which a given length is reached.
double parameter_at(const std::vector<double>& lengths, double length) {
  const auto above = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, length);
  const double part = (length - *(above - 1)) / (*above - *(above - 1));
  const auto step = static_cast<double>(above - 1 - lengths.begin());
  return 2 * std::numbers::pi * (step + part) / static_cast<double>(lengths.size() - 1);
}

void append_ring(const CurvePoint& centre, std::uint32_t sides, core::Mesh& mesh) {
  const Eigen::Vector3d binormal = centre.tangent.cross(centre.normal);
  for (std::uint32_t side = 0; side < sides; ++side) {
    const double phi = 2 * std::numbers::pi * side / sides;
    const Eigen::Vector3d normal = std::cos(phi) * centre.normal + std::sin(phi) * binormal;
    mesh.positions.emplace_back((centre.position + kTubeRadius * normal).cast<float>());
    mesh.normals.emplace_back(normal.cast<float>().normalized());
  }
}

}  // namespace

core::Mesh torus_knot(int vertices) {
  assert(vertices >= kMinKnotVertices && vertices <= kMaxKnotVertices);

  // Choose rings and sides so that the quads are about square.
  const std::vector<double> lengths = cumulative_lengths();
  const double aspect = lengths.back() / (2 * std::numbers::pi * kTubeRadius);
  const auto sides = static_cast<std::uint32_t>(std::lround(std::sqrt(vertices / aspect)));
  const auto rings = static_cast<std::uint32_t>(std::lround(vertices / static_cast<double>(sides)));

  core::Mesh mesh;
  mesh.positions.reserve(std::size_t{rings} * sides);
  mesh.normals.reserve(std::size_t{rings} * sides);
  mesh.triangles.reserve(std::size_t{rings} * sides * 2);
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    append_ring(knot_at(parameter_at(lengths, lengths.back() * ring / rings)), sides, mesh);
  }

  // Join neighbouring rings; the last one closes on the first.
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const std::uint32_t here = ring * sides;
    const std::uint32_t there = (ring + 1) % rings * sides;
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t next = (side + 1) % sides;
      mesh.triangles.emplace_back(here + side, here + next, there + next);
      mesh.triangles.emplace_back(here + side, there + next, there + side);
    }
  }
  return mesh;
}

}  // namespace sheen::capture::synthetic
