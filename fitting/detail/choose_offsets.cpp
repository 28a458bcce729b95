// SPDX-License-Identifier: MIT
#include "fitting/detail/choose_offsets.h"

#include "core/concurrency/parallel_for.h"
#include "core/geometry/disc_map.h"
#include "core/geometry/tangent_frame.h"
#include "fitting/detail/check_directions.h"
#include "fitting/detail/fit_anchors.h"
#include "fitting/detail/patch_kernels.h"
#include "fitting/sparse/columns.h"
#include "fitting/sparse/light_field_model.h"
#include "fitting/sparse/workspaces.h"

#include <Eigen/Core>

#include <array>
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

  /// sum += what they say at a place.
  void add(std::size_t triangle, const Eigen::Vector3f& barycentric, const DirectionRows& w,
           const ColourRows& sum) const {
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = mesh_.triangles[triangle][corner];
      const AskedPatch asked{frames_[vertex], frames_[vertex].normal, false};
      add_patch(asked, models_.patch(vertex), barycentric[corner], w, sum);
    }
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

/// What `offsets` leave of a triangle's samples.
template <typename Offsets>
std::vector<Eigen::Vector3f> left_by(const Offsets& offsets, const TriangleSamples& samples,
                                     std::size_t triangle, const std::vector<TriangleSample>& all) {
  std::array<sparse::Column, 3> w{}, said{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      w[axis].row[i] = all[i].w[static_cast<Eigen::Index>(axis)];
    }
  }
  offsets.add(triangle, samples.middle(triangle),
              {w[0].row, w[1].row, w[2].row, sparse::padded(all.size())},
              {said[0].row, said[1].row, said[2].row});
  std::vector<Eigen::Vector3f> left(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    left[i] = all[i].rgb - Eigen::Vector3f(said[0].row[i], said[1].row[i], said[2].row[i]);
  }
  return left;
}

/// Of what `offsets` predict of a triangle's checks: how they differ from the mean of the others.
template <typename Offsets>
SquaredError error_on(const Offsets& offsets, const TriangleSamples& samples,
                      std::size_t triangle) {
  const std::vector<TriangleSample> all = samples.of(triangle);
  const std::vector<Eigen::Vector3f> left = left_by(offsets, samples, triangle, all);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weight = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (is_check_direction(all[i].w)) continue;
    sum += all[i].weight * left[i];
    weight += all[i].weight;
  }
  SquaredError error;
  if (!(weight > 0.0f)) return error;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!is_check_direction(all[i].w)) continue;
    error.squared += static_cast<double>(all[i].weight * (left[i] - sum / weight).squaredNorm());
    error.weight += static_cast<double>(all[i].weight);
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
  OffsetErrors errors{error_of(vertex, samples, threads), 0};
  const auto anchors_win = [&](const AnchoredOffsets& anchors) {
    errors.anchors = error_of(anchors, samples, threads);
    return errors.anchors_win();
  };
  anchors_win(fit_anchored_offsets(mesh, samples, FittedDirections::without_checks, spacing_m,
                                   options, tolerance, threads, anchors_win));
  return errors;
}

}  // namespace sheen::fitting::detail
