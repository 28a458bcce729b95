// SPDX-License-Identifier: MIT
#include "reconstruction/refine/displacement.h"

#include <cstdint>
#include <limits>

namespace sheen::reconstruction {
namespace {

constexpr int kMostRounds = 150;
constexpr double kTolerance = 1e-6;

/// One weighted equation in one or two unknowns: a d[i] + b d[j] = r.
struct Row {
  std::uint32_t i, j;
  double a, b, r, weight;
};

std::vector<Row> equations(const core::Mesh& mesh, const std::vector<RimPoint>& rims,
                           const std::vector<Eigen::Vector3f>& triangle_normals,
                           const DisplacementWeights& weights) {
  std::vector<Row> rows;
  rows.reserve(rims.size() + 2 * mesh.positions.size() + 3 * mesh.triangles.size());
  for (const RimPoint& rim : rims) {
    const auto share = static_cast<double>(rim.share);
    rows.push_back({rim.vertices[0], rim.vertices[1], 1 - share, share,
                    static_cast<double>(rim.shift_m),
                    static_cast<double>(weights.rims * rim.weight)});
  }
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    rows.push_back({v, v, 1, 0, 0, static_cast<double>(weights.stay)});
  }
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& t = mesh.triangles[f];
    const Eigen::Vector3f& n = triangle_normals[f];
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t i = t[c];
      const std::uint32_t j = t[(c + 1) % 3];
      rows.push_back({i, j, -static_cast<double>(n.dot(mesh.normals[i])),
                      static_cast<double>(n.dot(mesh.normals[j])),
                      -static_cast<double>(n.dot(mesh.positions[j] - mesh.positions[i])),
                      static_cast<double>(weights.smoothness)});
    }
  }
  return rows;
}

using Vector = Eigen::VectorXd;

/// A^T W A x.
void apply(const std::vector<Row>& rows, const Vector& x, Vector& y) {
  y.setZero();
  for (const Row& row : rows) {
    const double e = row.weight * (row.a * x[row.i] + row.b * x[row.j]);
    y[row.i] += row.a * e;
    y[row.j] += row.b * e;
  }
}

}  // namespace

std::vector<float> solve_displacement(const core::Mesh& mesh, const std::vector<RimPoint>& rims,
                                      const std::vector<Eigen::Vector3f>& triangle_normals,
                                      const DisplacementWeights& weights) {
  const std::vector<Row> rows = equations(mesh, rims, triangle_normals, weights);
  const auto n = static_cast<Eigen::Index>(mesh.positions.size());
  Vector diagonal = Vector::Zero(n);
  Vector residual = Vector::Zero(n);
  for (const Row& row : rows) {
    diagonal[row.i] += row.weight * row.a * row.a;
    diagonal[row.j] += row.weight * row.b * row.b;
    residual[row.i] += row.weight * row.a * row.r;
    residual[row.j] += row.weight * row.b * row.r;
  }
  diagonal = diagonal.cwiseMax(std::numeric_limits<double>::min());
  Vector x = Vector::Zero(n);
  Vector z = residual.cwiseQuotient(diagonal);
  Vector direction = z;
  Vector image(n);
  double energy = residual.dot(z);
  const double enough = kTolerance * kTolerance * energy;
  for (int round = 0; round < kMostRounds && energy > enough; ++round) {
    apply(rows, direction, image);
    const double step = energy / direction.dot(image);
    x += step * direction;
    residual -= step * image;
    z = residual.cwiseQuotient(diagonal);
    const double next = residual.dot(z);
    direction = z + (next / energy) * direction;
    energy = next;
  }
  std::vector<float> displacement(mesh.positions.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    displacement[static_cast<std::size_t>(i)] = static_cast<float>(x[i]);
  }
  return displacement;
}

}  // namespace sheen::reconstruction
