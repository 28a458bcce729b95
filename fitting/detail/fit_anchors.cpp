// SPDX-License-Identifier: MIT
#include "fitting/detail/fit_anchors.h"

#include "core/concurrency/parallel_for.h"
#include "core/mesh/interpolation.h"
#include "fitting/detail/detail_light_field.h"
#include "fitting/sparse/workspaces.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

namespace sheen::fitting::detail {
namespace {

/// Of the levels, in spacings of the finest.
constexpr std::array<float, 2> kSpacings{8.0f / 3.0f, 1.0f};
/// Levels in the order in which they are fitted.
constexpr std::array<std::size_t, 7> kSweeps{0, 0, 1, 1, 0, 1, 1};
/// Part of a patch's tolerance that an anchor minds: the noise of many samples averages out.
constexpr float kToleranceShare = 0.5f;

sparse::LightFieldModel zeros(std::size_t count) {
  return no_offsets(std::vector<std::uint8_t>(count, 1));
}

/// Samples of all triangles, and what anchors leave of their differences from the triangles' means.
class Residuals {
 public:
  struct Sample {
    Eigen::Vector3f w;
    float weight;
    Eigen::Vector3f left;
    std::array<Eigen::Vector3f, kSpacings.size()> said;  ///< by the anchors of a level
  };

  Residuals(const TriangleSamples& samples, FittedDirections fitted, int threads)
      : samples_(samples), threads_(threads), offsets_(1, 0) {
    const Eigen::Vector3f nothing = Eigen::Vector3f::Zero();
    for (std::size_t triangle = 0; triangle < samples.triangle_count(); ++triangle) {
      for (const TriangleSample& one : samples.of(triangle)) {
        if (fitted == FittedDirections::without_checks && is_check_direction(one.w)) continue;
        left_.push_back({one.w, one.weight, one.rgb, {nothing, nothing}});
      }
      offsets_.push_back(left_.size());
    }
  }

  /// After the anchors of a level have changed; returns the weighted sum of squares.
  double update(const AnchoredOffsets& anchors, std::size_t level) {
    std::vector<double> squared(offsets_.size() - 1, 0.0);
    core::parallel_for(squared.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t triangle = begin; triangle < end; ++triangle) {
        squared[triangle] = update(anchors, level, triangle);
      }
    });
    return std::accumulate(squared.begin(), squared.end(), 0.0);
  }

  [[nodiscard]] std::span<const Sample> of(std::size_t triangle) const {
    return {left_.data() + offsets_[triangle], offsets_[triangle + 1] - offsets_[triangle]};
  }

 private:
  double update(const AnchoredOffsets& anchors, std::size_t level, std::size_t triangle) {
    const std::span<Sample> samples(left_.data() + offsets_[triangle],
                                    offsets_[triangle + 1] - offsets_[triangle]);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float weight = 0;
    const LevelAtPlace place = anchors.level_at(level, triangle, samples_.middle(triangle));
    for (Sample& one : samples) {
      const Eigen::Vector3f said = place.colour(one.w);
      one.left += std::exchange(one.said[level], said) - said;
      sum += one.weight * one.left;
      weight += one.weight;
    }
    if (!(weight > 0.0f)) return 0;
    double squared = 0;
    for (Sample& one : samples) {
      one.left -= sum / weight;
      squared += static_cast<double>(one.weight * one.left.squaredNorm());
    }
    return squared;
  }

  const TriangleSamples& samples_;
  int threads_;
  std::vector<std::size_t> offsets_;
  std::vector<Sample> left_;
};

/// A triangle that blends an anchor, and the weight in its middle.
struct Follower {
  std::uint32_t triangle;
  float weight;
};

/// Those of each anchor, in order.
std::vector<std::vector<Follower>> followers_of(const AnchoredOffsets& anchors,
                                                const TriangleSamples& samples) {
  std::vector<std::vector<Follower>> followers(anchors.models().patch_count());
  for (std::uint32_t triangle = 0; triangle < samples.triangle_count(); ++triangle) {
    for (const CornerWeights& blend : anchors.blends(triangle)) {
      const float weight = blend.at(samples.middle(triangle));
      if (weight > 0.0f) followers[blend.anchor].push_back({triangle, weight});
    }
  }
  return followers;
}

/// Cells along a side of grids over the disc of directions, fine to coarse.
constexpr std::array<int, 9> kGrids{40, 30, 22, 16, 13, 11, 8, 5, 2};
constexpr std::size_t kMostCells = std::size_t{kGrids[0]} * kGrids[0];

std::size_t cell_at(const Eigen::Vector2f& uv, int grid) {
  const auto along = [&](float x) {
    return std::clamp(static_cast<int>(0.5f * (x + 1.0f) * static_cast<float>(grid)), 0, grid - 1);
  };
  return static_cast<std::size_t>(along(uv.y()) * grid + along(uv.x()));
}

/// The finest of which directions touch no more than `most` (>= 4) cells.
int grid_for(std::span<const Eigen::Vector2f> directions, std::size_t most) {
  for (const int grid : kGrids) {
    std::bitset<kMostCells> touched;
    for (const Eigen::Vector2f& uv : directions) touched.set(cell_at(uv, grid));
    if (touched.count() <= most) return grid;
  }
  return kGrids.back();
}

/// What all anchors are fitted from.
struct Given {
  const core::Mesh& mesh;
  const TriangleSamples& samples;
  const sparse::Options& options;
  float tolerance;
  int threads;
};

/// What anchors are asked for, in cells of directions.
class AskedCells {
 public:
  /// Gathers what the followers of an anchor ask it for.
  void gather(const AnchoredOffsets& anchors, std::size_t anchor,
              std::span<const Follower> followers, const Given& given, const Residuals& residuals) {
    uvs_.clear();
    for (const Follower& follower : followers) {
      const Eigen::Vector3f n =
          core::normal_on(given.mesh, follower.triangle, given.samples.middle(follower.triangle));
      for (const Residuals::Sample& one : residuals.of(follower.triangle)) {
        uvs_.push_back(anchors.uv_at(anchor, n, one.w));
      }
    }
    const int grid = grid_for(uvs_, static_cast<std::size_t>(given.options.max_samples));
    cells_.fill({});
    std::size_t next = 0;
    for (const Follower& follower : followers) {
      for (const Residuals::Sample& one : residuals.of(follower.triangle)) {
        const Eigen::Vector2f& uv = uvs_[next++];
        // Squared: what lies near an anchor is its own.
        cells_[cell_at(uv, grid)].add(follower.weight * follower.weight * one.weight, uv, one.left);
      }
    }
  }

  /// A sample for every cell: what the anchor says there itself and what is left.
  std::span<const sparse::DirectedColour> read(const AnchoredOffsets& anchors, std::size_t anchor,
                                               std::span<sparse::DirectedColour> samples) const {
    std::size_t count = 0;
    for (const Cell& cell : cells_) {
      if (!(cell.weight > 0.0f)) continue;
      const Eigen::Vector2f uv = cell.uv / cell.weight;
      samples[count++] = {uv, anchors.models().colour(anchor, uv) + cell.left / cell.weight};
    }
    return samples.first(count);
  }

 private:
  /// Weighted sums.
  struct Cell {
    float weight = 0;
    Eigen::Vector2f uv = Eigen::Vector2f::Zero();
    Eigen::Vector3f left = Eigen::Vector3f::Zero();

    void add(float w, const Eigen::Vector2f& at, const Eigen::Vector3f& colour) {
      weight += w;
      uv += w * at;
      left += w * colour;
    }
  };

  std::vector<Eigen::Vector2f> uvs_;
  std::array<Cell, kMostCells> cells_;
};

using Models = std::vector<sparse::PatchModel>;

/// Every anchor of a level anew, towards its own value and what all together left.
void sweep(const Given& given, const Residuals& residuals,
           const std::vector<std::vector<Follower>>& followers, std::size_t level,
           AnchoredOffsets& anchors) {
  const std::size_t first = anchors.first_of(level);
  Models next(anchors.first_of(level + 1) - first);
  sparse::Workspaces workspaces(given.options);
  core::parallel_for(
      next.size(), given.threads,
      [&](std::size_t begin, std::size_t end) {
        AskedCells cells;
        workspaces.with_one([&](sparse::Workspace& workspace) {
          workspace.selection.set_tolerance(given.tolerance);
          for (std::size_t i = begin; i < end; ++i) {
            cells.gather(anchors, first + i, followers[first + i], given, residuals);
            const auto samples = cells.read(anchors, first + i, workspace.samples);
            if (!samples.empty()) next[i] = workspace.selection.choose(samples).model;
            if (next[i].term_count() == 1) next[i].coefficient[0].setZero();
          }
        });
      },
      16);
  for (std::size_t i = 0; i < next.size(); ++i) anchors.models().store(first + i, next[i]);
}

/// Anchors and what they leave.
struct Swept {
  AnchoredOffsets anchors;
  double squared;
};

Swept swept(const Given& given, AnchoredOffsets anchors, std::span<const std::size_t> levels,
            Residuals& residuals) {
  const auto followers = followers_of(anchors, given.samples);
  double squared = 0;
  for (std::size_t level = 0; level < kSpacings.size(); ++level) {
    squared = residuals.update(anchors, level);
  }
  for (const std::size_t level : levels) {
    sweep(given, residuals, followers, level, anchors);
    squared = residuals.update(anchors, level);
  }
  return {std::move(anchors), squared};
}

/// Asked in the directions that leave less after the first sweep.
AnchoredOffsets fitted(const Given& given, const std::vector<AnchorLevel>& levels,
                       Residuals& residuals) {
  std::size_t count = 0;
  for (const AnchorLevel& level : levels) count += level.vertices.size();
  const std::span sweeps(kSweeps);
  const auto first = [&](AskedDirection asked) {
    return swept(given, {given.mesh, levels, asked, zeros(count)}, sweeps.first(1), residuals);
  };
  Swept same = first(AskedDirection::same);
  Swept mirrored = first(AskedDirection::mirrored);
  Swept& better = mirrored.squared < same.squared ? mirrored : same;
  return swept(given, std::move(better.anchors), sweeps.subspan(1), residuals).anchors;
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

Eigen::Vector3f mean_over_views(const AnchoredOffsets& anchors, std::size_t vertex,
                                std::span<const sparse::KeptSample> samples) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weight = 0;
  for (const sparse::KeptSample& kept : samples) {
    sum += kept.weight * anchors.colour_at(vertex, kept.sample.uv);
    weight += kept.weight;
  }
  return weight > 0.0f ? Eigen::Vector3f(sum / weight) : Eigen::Vector3f::Zero();
}

}  // namespace

AnchoredOffsets fit_anchored_offsets(const core::Mesh& mesh, const TriangleSamples& samples,
                                     FittedDirections directions, float spacing_m,
                                     const sparse::Options& options, float tolerance, int threads) {
  const Given given{mesh, samples, options, kToleranceShare * tolerance, threads};
  std::vector<AnchorLevel> levels;
  for (const float spacings : kSpacings) {
    levels.push_back({scatter_anchors(mesh, spacings * spacing_m), spacings * spacing_m});
  }
  Residuals residuals(samples, directions, threads);
  return fitted(given, levels, residuals);
}

FittedAnchors fit_anchors(const core::Mesh& mesh, const sparse::SparseFitter& patches,
                          const TriangleSamples& samples, float spacing_m,
                          const sparse::Options& options, int threads) {
  const float tolerance = patches.statistics().tolerance.value_or(sparse::kToleranceOfUnknownNoise);
  const AnchoredOffsets anchors = fit_anchored_offsets(mesh, samples, FittedDirections::all,
                                                       spacing_m, options, tolerance, threads);
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
