// SPDX-License-Identifier: MIT
#include "fitting/detail/fit_anchors.h"

#include "core/concurrency/parallel_for.h"
#include "core/geometry/disc_map.h"
#include "core/geometry/tangent_frame.h"
#include "core/mesh/interpolation.h"
#include "fitting/detail/anchor_residuals.h"
#include "fitting/detail/asked_cells.h"
#include "fitting/detail/detail_light_field.h"
#include "fitting/sparse/columns.h"
#include "fitting/sparse/workspaces.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace sheen::fitting::detail {
namespace {

/// Of the levels, in spacings of the finest.
constexpr std::array<float, kAnchorLevels> kSpacings{8.0f / 3.0f, 1.0f};
/// Levels in the order in which they are swept, first and then again.
constexpr std::array<std::size_t, 4> kFirstSweeps{0, 0, 1, 1};
constexpr std::array<std::size_t, 3> kFurtherSweeps{0, 1, 1};
/// Part of a patch's tolerance that an anchor minds: the noise of many samples averages out.
constexpr float kToleranceShare = 0.5f;

sparse::LightFieldModel zeros(std::size_t count) {
  return no_offsets(std::vector<std::uint8_t>(count, 1));
}

/// What all anchors are fitted from.
struct Given {
  const core::Mesh& mesh;
  const TriangleSamples& samples;
  const sparse::Options& options;
  float tolerance;
  int threads;
};

/// Of each anchor, in order.
std::vector<std::vector<Follower>> followers_of(const AnchoredOffsets& anchors,
                                                const Given& given) {
  std::vector<std::vector<Follower>> followers(anchors.models().patch_count());
  for (std::uint32_t triangle = 0; triangle < given.samples.triangle_count(); ++triangle) {
    const Eigen::Vector3f& middle = given.samples.middle(triangle);
    const Eigen::Vector3f n = core::normal_on(given.mesh, triangle, middle);
    for (const CornerWeights& blend : anchors.blends(triangle)) {
      const float weight = blend.at(middle);
      if (weight > 0.0f) followers[blend.anchor].push_back({triangle, weight, n});
    }
  }
  return followers;
}

using Models = std::vector<sparse::PatchModel>;

/// Anchors on their way.
class AnchorFit {
 public:
  AnchorFit(const Given& given, AnchoredOffsets start, AnchorResiduals& residuals)
      : given_(given),
        residuals_(residuals),
        anchors_(std::move(start)),
        followers_(followers_of(anchors_, given)),
        cells_(followers_.size()) {}

  /// Makes the residuals those of these anchors.
  void leave() {
    for (std::size_t level = 0; level < kAnchorLevels; ++level) {
      residuals_.update(anchors_, level);
    }
  }

  /// Sweeps over all anchors of these levels, one after another; returns what they leave, the
  /// weighted sum of squares.
  double sweep(std::span<const std::size_t> levels) {
    double squared = 0;
    for (const std::size_t level : levels) {
      sweep(level);
      squared = residuals_.update(anchors_, level);
    }
    return squared;
  }

  [[nodiscard]] AnchoredOffsets& anchors() { return anchors_; }

 private:
  /// Every anchor of a level anew, towards its own value and what all together left.
  void sweep(std::size_t level) {
    const std::size_t first = anchors_.first_of(level);
    Models next(anchors_.first_of(level + 1) - first);
    sparse::Workspaces workspaces(given_.options);
    core::parallel_for(
        next.size(), given_.threads,
        [&](std::size_t begin, std::size_t end) {
          workspaces.with_one([&](sparse::Workspace& workspace) {
            workspace.selection.set_tolerance(given_.tolerance);
            for (std::size_t i = begin; i < end; ++i) next[i] = chosen(first + i, workspace);
          });
        },
        16);
    for (std::size_t i = 0; i < next.size(); ++i) anchors_.models().store(first + i, next[i]);
  }

  [[nodiscard]] sparse::PatchModel chosen(std::size_t anchor, sparse::Workspace& workspace) {
    const std::span<const Follower> followers = followers_[anchor];
    AskedCells& cells = cells_[anchor];
    if (cells.empty()) {
      cells = AskedCells(anchors_, anchor, followers, residuals_,
                         static_cast<std::size_t>(given_.options.max_samples));
    }
    const auto samples = cells.read(anchors_, anchor, followers, residuals_, workspace.samples);
    sparse::PatchModel model;
    if (!samples.empty()) model = workspace.selection.choose(samples).model;
    if (model.term_count() == 1) model.coefficient[0].setZero();
    return model;
  }

  const Given& given_;
  AnchorResiduals& residuals_;
  AnchoredOffsets anchors_;
  std::vector<std::vector<Follower>> followers_;  ///< of every anchor
  std::vector<AskedCells> cells_;                 ///< of those that have been fitted
};

/// Asked in the directions that leave less after the first sweep.
AnchoredOffsets fitted(const Given& given, const std::vector<AnchorLevel>& levels,
                       AnchorResiduals& residuals, const IsEnough& is_enough) {
  std::size_t count = 0;
  for (const AnchorLevel& level : levels) count += level.vertices.size();
  const auto start = [&](AskedDirection asked) {
    return AnchorFit(given, {given.mesh, levels, asked, zeros(count)}, residuals);
  };
  const std::span first(kFirstSweeps);
  const auto left_by = [&](AnchorFit& fit) {
    fit.leave();
    return fit.sweep(first.first(1));
  };
  AnchorFit same = start(AskedDirection::same);
  AnchorFit mirrored = start(AskedDirection::mirrored);
  const double left_by_same = left_by(same);
  AnchorFit& better = left_by(mirrored) < left_by_same ? mirrored : same;
  better.leave();
  better.sweep(first.subspan(1));
  if (!is_enough(better.anchors())) better.sweep(kFurtherSweeps);
  return std::move(better.anchors());
}

/// Anchors of a level that some vertex needs: one that differs from zero needs all that it blends.
std::vector<std::uint8_t> needed(const core::Mesh& mesh, const AnchoredOffsets& anchors,
                                 std::size_t level) {
  const AnchorLevel& all = anchors.levels()[level];
  std::vector<std::uint8_t> is_needed(all.vertices.size(), 0);
  for (const AnchorBlend& blend : blend_anchors(mesh, all.vertices, all.spacing_m)) {
    bool differs = false;
    for (std::size_t i = 0; i < kMostBlended && blend.weight[i] > 0.0f; ++i) {
      const std::size_t anchor = anchors.first_of(level) + blend.anchor[i];
      differs = differs || anchors.models().term_count(anchor) > 1;
    }
    for (std::size_t i = 0; differs && i < kMostBlended && blend.weight[i] > 0.0f; ++i) {
      is_needed[blend.anchor[i]] = 1;
    }
  }
  return is_needed;
}

/// Without those that only blend with zeros.
std::shared_ptr<const AnchoredOffsets> without_idle(const core::Mesh& mesh,
                                                    const AnchoredOffsets& anchors) {
  std::vector<AnchorLevel> levels;
  Models models;
  for (std::size_t level = 0; level < anchors.levels().size(); ++level) {
    const AnchorLevel& all = anchors.levels()[level];
    const std::vector<std::uint8_t> is_needed = needed(mesh, anchors, level);
    levels.push_back({{}, all.spacing_m});
    for (std::size_t i = 0; i < is_needed.size(); ++i) {
      if (is_needed[i] == 0) continue;
      levels.back().vertices.push_back(all.vertices[i]);
      models.push_back(anchors.models().patch(anchors.first_of(level) + i));
    }
  }
  if (models.empty()) return nullptr;
  sparse::LightFieldModel kept = zeros(models.size());
  for (std::size_t i = 0; i < models.size(); ++i) kept.store(i, models[i]);
  return std::make_shared<const AnchoredOffsets>(mesh, std::move(levels), anchors.asked(),
                                                 std::move(kept));
}

/// What anchors say of a vertex, on average over its views.
Eigen::Vector3f mean_over_views(const AnchoredOffsets& anchors, std::size_t vertex,
                                std::span<const sparse::KeptSample> samples) {
  const core::TangentFrame frame = core::tangent_frame(anchors.mesh().normals[vertex]);
  std::array<sparse::Column, 3> w{}, said{};
  float weight = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3f towards_viewer =
        frame.in_object(core::hemisphere_from_disc(samples[i].sample.uv));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      w[axis].row[i] = towards_viewer[static_cast<Eigen::Index>(axis)];
    }
    weight += samples[i].weight;
  }
  if (!(weight > 0.0f)) return Eigen::Vector3f::Zero();
  anchors.add_at(vertex, {w[0].row, w[1].row, w[2].row, sparse::padded(samples.size())},
                 {said[0].row, said[1].row, said[2].row});
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sum += samples[i].weight * Eigen::Vector3f(said[0].row[i], said[1].row[i], said[2].row[i]);
  }
  return sum / weight;
}

}  // namespace

AnchoredOffsets fit_anchored_offsets(const core::Mesh& mesh, const TriangleSamples& samples,
                                     FittedDirections directions, float spacing_m,
                                     const sparse::Options& options, float tolerance, int threads,
                                     const IsEnough& is_enough) {
  const Given given{mesh, samples, options, kToleranceShare * tolerance, threads};
  std::vector<AnchorLevel> levels;
  for (const float spacings : kSpacings) {
    levels.push_back({scatter_anchors(mesh, spacings * spacing_m), spacings * spacing_m});
  }
  AnchorResiduals residuals(samples, directions, threads);
  return fitted(given, levels, residuals, is_enough);
}

FittedAnchors fit_anchors(const core::Mesh& mesh, const sparse::SparseFitter& patches,
                          const TriangleSamples& samples, float spacing_m,
                          const sparse::Options& options, int threads) {
  const float tolerance = patches.statistics().tolerance.value_or(sparse::kToleranceOfUnknownNoise);
  const AnchoredOffsets anchors =
      fit_anchored_offsets(mesh, samples, FittedDirections::all, spacing_m, options, tolerance,
                           threads, [](const AnchoredOffsets& /*early*/) { return false; });
  FittedAnchors found{without_idle(mesh, anchors),
                      std::vector<Eigen::Vector3f>(mesh.positions.size(), Eigen::Vector3f::Zero())};
  if (!found.offsets) return found;
  core::parallel_for(found.mean.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t vertex = begin; vertex < end; ++vertex) {
      found.mean[vertex] = mean_over_views(*found.offsets, vertex, patches.samples_of(vertex));
    }
  });
  return found;
}

}  // namespace sheen::fitting::detail
