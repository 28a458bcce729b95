// SPDX-License-Identifier: MIT
#include "fitting/detail/choose_offsets.h"

#include "core/concurrency/parallel_for.h"
#include "core/geometry/disc_map.h"
#include "core/geometry/tangent_frame.h"
#include "fitting/detail/check_directions.h"
#include "fitting/detail/fit_anchors.h"
#include "fitting/sparse/light_field_model.h"
#include "fitting/sparse/workspaces.h"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::detail {
namespace {

/// Patches at vertices, interpolated across triangles.
class VertexOffsets {
 public:
  /// Fitted to the samples of `patches` that are no checks.
  VertexOffsets(const core::Mesh& mesh, const sparse::SparseFitter& patches,
                const sparse::Options& options, float tolerance, int threads)
      : mesh_(mesh), frames_(mesh.positions.size()), models_(mesh.positions.size()) {
    std::vector<sparse::PatchModel> chosen(frames_.size());
    sparse::Workspaces workspaces(options);
    core::parallel_for(frames_.size(), threads, [&](std::size_t begin, std::size_t end) {
      workspaces.with_one([&](sparse::Workspace& workspace) {
        workspace.selection.set_tolerance(tolerance);
        for (std::size_t vertex = begin; vertex < end; ++vertex) {
          frames_[vertex] = core::tangent_frame(mesh.normals[vertex]);
          const auto samples = fitted_samples(patches, vertex, workspace.samples);
          if (samples.empty()) {
            chosen[vertex].coefficient[0].setZero();
          } else {
            chosen[vertex] = workspace.selection.choose(samples).model;
          }
        }
      });
    });
    for (std::size_t vertex = 0; vertex < chosen.size(); ++vertex) {
      models_.store(vertex, chosen[vertex]);
    }
  }

  [[nodiscard]] Eigen::Vector3f colour(std::size_t triangle, const Eigen::Vector3f& barycentric,
                                       const Eigen::Vector3f& w) const {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = mesh_.triangles[triangle][corner];
      const core::TangentFrame& frame = frames_[vertex];
      const Eigen::Vector2f uv(w.dot(frame.tangent), w.dot(frame.bitangent));
      // Behind the vertex's horizon: on the rim.
      const bool is_behind = w.dot(frame.normal) < 0.0f && uv.squaredNorm() > 0.0f;
      sum += barycentric[corner] * models_.colour(vertex, is_behind ? uv.normalized() : uv);
    }
    return sum;
  }

 private:
  [[nodiscard]] std::span<const sparse::DirectedColour> fitted_samples(
      const sparse::SparseFitter& patches, std::size_t vertex,
      std::span<sparse::DirectedColour> samples) const {
    std::size_t count = 0;
    for (const sparse::KeptSample& kept : patches.samples_of(vertex)) {
      const Eigen::Vector3f w =
          frames_[vertex].in_object(core::hemisphere_from_disc(kept.sample.uv));
      if (!is_check_direction(w)) samples[count++] = kept.sample;
    }
    return samples.first(count);
  }

  const core::Mesh& mesh_;
  std::vector<core::TangentFrame> frames_;
  sparse::LightFieldModel models_;
};

/// Weighted sum of squares, and the weights'.
struct SquaredError {
  double squared = 0, weight = 0;
};

/// Of what `offsets` predict of a triangle's checks: how they differ from the mean of the others.
template <typename Offsets>
SquaredError error_on(const Offsets& offsets, const TriangleSamples& samples,
                      std::size_t triangle) {
  const std::vector<TriangleSample> all = samples.of(triangle);
  const auto left = [&](const TriangleSample& one) -> Eigen::Vector3f {
    return one.rgb - offsets.colour(triangle, samples.middle(triangle), one.w);
  };
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weight = 0;
  for (const TriangleSample& one : all) {
    if (is_check_direction(one.w)) continue;
    sum += one.weight * left(one);
    weight += one.weight;
  }
  SquaredError error;
  if (!(weight > 0.0f)) return error;
  for (const TriangleSample& one : all) {
    if (!is_check_direction(one.w)) continue;
    error.squared += static_cast<double>(one.weight * (left(one) - sum / weight).squaredNorm());
    error.weight += static_cast<double>(one.weight);
  }
  return error;
}

template <typename Offsets>
double error_of(const Offsets& offsets, const TriangleSamples& samples, int threads) {
  std::vector<SquaredError> errors(samples.triangle_count());
  core::parallel_for(errors.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t triangle = begin; triangle < end; ++triangle) {
      errors[triangle] = error_on(offsets, samples, triangle);
    }
  });
  // In their order.
  SquaredError all;
  for (const SquaredError& one : errors) {
    all.squared += one.squared;
    all.weight += one.weight;
  }
  return all.weight > 0 ? std::sqrt(all.squared / (3 * all.weight)) : 0;
}

}  // namespace

OffsetErrors check_offsets(const core::Mesh& mesh, const sparse::SparseFitter& patches,
                           const TriangleSamples& samples, float spacing_m,
                           const sparse::Options& options, int threads) {
  const float tolerance = patches.statistics().tolerance.value_or(sparse::kToleranceOfUnknownNoise);
  const VertexOffsets vertex(mesh, patches, options, tolerance, threads);
  const AnchoredOffsets anchors = fit_anchored_offsets(
      mesh, samples, FittedDirections::without_checks, spacing_m, options, tolerance, threads);
  return {error_of(vertex, samples, threads), error_of(anchors, samples, threads)};
}

}  // namespace sheen::fitting::detail
