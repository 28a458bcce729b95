// SPDX-License-Identifier: MIT
#include "fitting/heights/height_system.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/heights/local_sums.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>

namespace sheen::fitting::heights {
namespace {

/// Neighbouring texels of a view differ from the mean alike (highlights, unsharp images, poses): so
/// many say as much as one.
constexpr double kAlike = 10;
constexpr double kLeastDeviation = 1;  ///< of a colour, of 255
constexpr int kMostIterations = 300;
constexpr double kSmallest = 1e-4;  ///< residual of the linear system, relative

}  // namespace

HeightSystem::HeightSystem(const HeightField& field, const core::Mesh& mesh,
                           std::span<const TrianglePlane> planes,
                           const detail::SurfaceTexels& surface, const core::Atlas& atlas,
                           std::span<const TexelStatistics> texels, int edges, int threads)
    : field_(field),
      mesh_(mesh),
      planes_(planes),
      surface_(surface),
      atlas_(atlas),
      texels_(texels),
      equations_(mesh.triangles.size()) {
  std::vector<GradientSums> gradients(equations_.size());
  const auto for_triangles = [&](const auto& body) {
    core::parallel_for(equations_.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) body(t);
    });
  };
  for_triangles([&](std::size_t t) { gradients[t] = gradients_of(t); });
  std::vector<GradientSums> around = sums_around(field, mesh, gradients, edges);
  for (GradientSums& sums : around) {
    if (sums[9] > 0.0f) sums /= sums[9];
  }
  for_triangles([&](std::size_t t) { equations_[t] = equations_of(t, around); });
  double scatter = 0;
  double weight = 0;
  for (const TriangleEquations& triangle : equations_) {
    scatter += triangle.scatter;
    weight += triangle.weight;
  }
  const double least = kLeastDeviation * kLeastDeviation;
  variance_ = kAlike * (weight > 0 ? std::max(least, scatter / weight) : least);
}

HeightSystem::GradientSums HeightSystem::gradients_of(std::size_t triangle_idx) const {
  GradientSums sums = GradientSums::Zero();
  const TrianglePlane& plane = planes_[triangle_idx];
  if (plane.normal.isZero(0)) return sums;
  for (const detail::SurfaceTexel& texel : surface_.of(triangle_idx)) {
    const float weight = texels_[texel.texel_idx].weight;
    if (!(weight > 0.0f)) continue;
    const auto gradient = mean_gradient(texels_, atlas_, texel.texel_idx);
    for (int channel = 0; channel < 3; ++channel) {
      sums.segment<3>(3 * channel) += weight * plane.atlas_from_object.transpose() *
                                      gradient[static_cast<std::size_t>(channel)];
    }
    sums[9] += weight;
  }
  return sums;
}

HeightSystem::TriangleEquations HeightSystem::equations_of(
    std::size_t triangle_idx, std::span<const GradientSums> around) const {
  TriangleEquations sums;
  const TrianglePlane& plane = planes_[triangle_idx];
  if (plane.normal.isZero(0)) return sums;
  // The neighbourhoods' gradients on the atlas, at the corners.
  std::array<std::array<Eigen::Vector2f, 3>, 3> mean;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const std::uint32_t vertex = mesh_.triangles[triangle_idx][static_cast<int>(corner)];
    const GradientSums& local = around[field_.of_vertex(vertex)];
    for (std::size_t channel = 0; channel < 3; ++channel) {
      mean[corner][channel] = plane.object_from_atlas.transpose() *
                              local.segment<3>(static_cast<Eigen::Index>(3 * channel));
    }
  }
  std::array<float, 3> rise{};
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const std::uint32_t vertex = mesh_.triangles[triangle_idx][static_cast<int>(corner)];
    rise[corner] = field_.directions()[field_.of_vertex(vertex)].dot(plane.normal);
  }
  for (const detail::SurfaceTexel& texel : surface_.of(triangle_idx)) {
    const TexelStatistics& known = texels_[texel.texel_idx];
    if (!(known.weight > 0.0f)) continue;
    const float at_first = 1.0f - texel.at_second - texel.at_third;
    auto gradient = mean_gradient(texels_, atlas_, texel.texel_idx);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      gradient[channel] -= at_first * mean[0][channel] + texel.at_second * mean[1][channel] +
                           texel.at_third * mean[2][channel];
    }
    const HeightEquation equation = height_equation(known, gradient);
    sums.scatter += static_cast<double>(known.scatter());
    sums.weight += 3 * static_cast<double>(known.weight);
    const std::array<double, 3> part{static_cast<double>(at_first * rise[0]),
                                     static_cast<double>(texel.at_second * rise[1]),
                                     static_cast<double>(texel.at_third * rise[2])};
    for (std::size_t i = 0; i < 3; ++i) {
      sums.matrix[i] += static_cast<double>(equation.a) * part[i] * part[i];
      sums.matrix[3 + i] += static_cast<double>(equation.a) * part[i] * part[(i + 1) % 3];
      sums.right[i] += static_cast<double>(equation.b) * part[i];
    }
  }
  return sums;
}

std::vector<std::uint8_t> HeightSystem::seen() const {
  std::vector<std::uint8_t> is_seen(field_.size(), 0);
  for (std::size_t t = 0; t < equations_.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto height = field_.of_vertex(mesh_.triangles[t][static_cast<int>(corner)]);
      if (equations_[t].matrix[corner] > 0) is_seen[height] = 1;
    }
  }
  return is_seen;
}

Eigen::VectorXd HeightSystem::step(const HeightPrior& prior, double longest_m) const {
  const auto count = static_cast<Eigen::Index>(field_.size());
  const std::vector<std::uint8_t> is_seen = seen();
  const Eigen::VectorXd& height = field_.heights();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(3 * field_.edges().size() + 9 * equations_.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  const auto add = [&](std::uint32_t row, std::uint32_t column, double value) {
    if (is_seen[row] != 0 && is_seen[column] != 0) {
      entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
    }
  };
  for (std::size_t t = 0; t < equations_.size(); ++t) {
    const TriangleEquations& triangle = equations_[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const auto row = field_.of_vertex(mesh_.triangles[t][static_cast<int>(i)]);
      const auto column = field_.of_vertex(mesh_.triangles[t][static_cast<int>(j)]);
      add(row, row, triangle.matrix[i] / variance_);
      add(row, column, triangle.matrix[3 + i] / variance_);
      add(column, row, triangle.matrix[3 + i] / variance_);
      right[row] += triangle.right[i] / variance_;
    }
  }
  for (const HeightField::Edge& edge : field_.edges()) {
    const double stiffness = 1 / std::pow(prior.slope * static_cast<double>(edge.length_m), 2);
    const double pull = stiffness * (height[edge.second] - height[edge.first]);
    add(edge.first, edge.first, stiffness);
    add(edge.second, edge.second, stiffness);
    add(edge.first, edge.second, -stiffness);
    add(edge.second, edge.first, -stiffness);
    right[edge.first] += pull;
    right[edge.second] -= pull;
  }
  for (std::uint32_t i = 0; i < field_.size(); ++i) {
    // A height that is not seen keeps its place, and so has an equation of its own.
    entries.emplace_back(static_cast<int>(i), static_cast<int>(i),
                         is_seen[i] != 0 ? prior.outline[i] : 1.0);
    right[i] = is_seen[i] != 0 ? right[i] - prior.outline[i] * height[i] : 0.0;
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
  solver.setMaxIterations(kMostIterations);
  solver.setTolerance(kSmallest);
  solver.compute(matrix);
  const Eigen::VectorXd step = solver.solve(right);
  if (!step.allFinite()) return Eigen::VectorXd::Zero(count);
  return step.cwiseMax(-longest_m).cwiseMin(longest_m);
}

}  // namespace sheen::fitting::heights
