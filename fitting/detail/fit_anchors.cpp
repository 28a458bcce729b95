// SPDX-License-Identifier: MIT
#include "fitting/detail/fit_anchors.h"

#include "core/concurrency/parallel_for.h"
#include "core/geometry/disc_map.h"
#include "core/geometry/tangent_frame.h"
#include "core/mesh/interpolation.h"
#include "fitting/detail/detail_light_field.h"
#include "fitting/detail/patch_kernels.h"
#include "fitting/sparse/columns.h"
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
/// Levels in the order in which they are swept, first and then again.
constexpr std::array<std::size_t, 4> kFirstSweeps{0, 0, 1, 1};
constexpr std::array<std::size_t, 3> kFurtherSweeps{0, 1, 1};
/// Part of a patch's tolerance that an anchor minds: the noise of many samples averages out.
constexpr float kToleranceShare = 0.5f;

sparse::LightFieldModel zeros(std::size_t count) {
  return no_offsets(std::vector<std::uint8_t>(count, 1));
}

/// Samples of all triangles, and what anchors leave of their differences from the triangles' means.
/// Number by number, of every triangle whole groups: those behind its samples weigh nothing.
class Residuals {
 public:
  using Numbers = std::vector<float>;
  using Colours = std::array<Numbers, 3>;

  Residuals(const TriangleSamples& samples, FittedDirections fitted, int threads)
      : samples_(samples), threads_(threads), first_(1, 0) {
    for (std::size_t triangle = 0; triangle < samples.triangle_count(); ++triangle) {
      for (const TriangleSample& one : samples.of(triangle)) {
        if (fitted == FittedDirections::without_checks && is_check_direction(one.w)) continue;
        append(one);
      }
      while (weight_.size() % sparse::kRowGroup != 0) append_nothing();
      first_.push_back(weight_.size());
    }
    for (Colours& said : said_) said.fill(Numbers(weight_.size(), 0.0f));
  }

  /// After the anchors of a level have changed; returns the weighted sum of squares.
  double update(const AnchoredOffsets& anchors, std::size_t level) {
    std::vector<double> squared(first_.size() - 1, 0.0);
    core::parallel_for(squared.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t triangle = begin; triangle < end; ++triangle) {
        squared[triangle] = update(anchors, level, triangle);
      }
    });
    return std::accumulate(squared.begin(), squared.end(), 0.0);
  }

  /// A triangle's samples.
  struct Rows {
    DirectionRows w;
    const float* weight;
    std::array<const float*, 3> left;
  };
  [[nodiscard]] Rows of(std::size_t triangle) const {
    const std::size_t first = first_[triangle];
    return {directions(triangle),
            weight_.data() + first,
            {left_[0].data() + first, left_[1].data() + first, left_[2].data() + first}};
  }

 private:
  void append(const TriangleSample& sample) {
    x_.push_back(sample.w.x());
    y_.push_back(sample.w.y());
    z_.push_back(sample.w.z());
    weight_.push_back(sample.weight);
    for (std::size_t c = 0; c < 3; ++c)
      left_[c].push_back(sample.rgb[static_cast<Eigen::Index>(c)]);
  }

  /// Where the last one lies, so that no other cell of directions is touched.
  void append_nothing() {
    append({{x_.back(), y_.back(), z_.back()}, Eigen::Vector3f::Zero(), 0.0f});
  }

  [[nodiscard]] DirectionRows directions(std::size_t triangle) const {
    const std::size_t first = first_[triangle];
    return {x_.data() + first, y_.data() + first, z_.data() + first, first_[triangle + 1] - first};
  }

  double update(const AnchoredOffsets& anchors, std::size_t level, std::size_t triangle) {
    const DirectionRows w = directions(triangle);
    std::array<sparse::Column, 3> said{};
    anchors.add_level(level, triangle, samples_.middle(triangle), w,
                      {said[0].row, said[1].row, said[2].row});
    const float* const weight = weight_.data() + first_[triangle];
    const float weights = std::accumulate(weight, weight + w.count, 0.0f);
    if (!(weights > 0.0f)) return 0;
    double squared = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      squared +=
          update(said[c], weight, weights, w.count, said_[level][c].data() + first_[triangle],
                 left_[c].data() + first_[triangle]);
    }
    return squared;
  }

  /// One channel of a triangle.
  static double update(const sparse::Column& now, const float* weight, float weights,
                       std::size_t count, float* said, float* left) {
    float sum = 0;
    for (std::size_t row = 0; row < count; ++row) {
      left[row] += std::exchange(said[row], now.row[row]) - now.row[row];
      sum += weight[row] * left[row];
    }
    float squared = 0;
    for (std::size_t row = 0; row < count; ++row) {
      left[row] -= sum / weights;
      squared += weight[row] * left[row] * left[row];
    }
    return static_cast<double>(squared);
  }

  const TriangleSamples& samples_;
  int threads_;
  std::vector<std::size_t> first_;
  Numbers x_, y_, z_, weight_;
  Colours left_;
  std::array<Colours, kSpacings.size()> said_;  ///< by the anchors of a level
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

/// The directions in which an anchor is asked, which do not change while it is fitted: cells of a
/// grid over its disc.
class AskedCells {
 public:
  AskedCells() = default;
  AskedCells(const AnchoredOffsets& anchors, std::size_t anchor,
             std::span<const Follower> followers, const Given& given, const Residuals& residuals) {
    const std::vector<Eigen::Vector2f> uvs = asked(anchors, anchor, followers, given, residuals);
    const int grid = grid_for(uvs, static_cast<std::size_t>(given.options.max_samples));
    number(uvs, grid);
    std::size_t next = 0;
    for (const Follower& follower : followers) {
      const Residuals::Rows rows = residuals.of(follower.triangle);
      for (std::size_t row = 0; row < rows.w.count; ++row, ++next) {
        Cell& cell = cells_[of_sample_[next]];
        const float weight = follower.weight * follower.weight * rows.weight[row];
        cell.weight += weight;
        cell.uv += weight * uvs[next];
      }
    }
    for (Cell& cell : cells_) {
      if (cell.weight > 0.0f) cell.uv /= cell.weight;
    }
  }

  [[nodiscard]] bool empty() const { return cells_.empty(); }

  /// A sample for every cell: what the anchor says there itself and what is left.
  std::span<const sparse::DirectedColour> read(const AnchoredOffsets& anchors, std::size_t anchor,
                                               std::span<const Follower> followers,
                                               const Residuals& residuals,
                                               std::span<sparse::DirectedColour> samples) const {
    std::array<Eigen::Vector3f, sparse::kMaxStoredSamples> left;
    std::fill_n(left.begin(), cells_.size(), Eigen::Vector3f::Zero());
    const std::uint8_t* cell = of_sample_.data();
    for (const Follower& follower : followers) {
      const auto& [w, weight, of] = residuals.of(follower.triangle);
      // Squared: what lies near an anchor is its own.
      const float squared = follower.weight * follower.weight;
      for (std::size_t row = 0; row < w.count; ++row) {
        left[*cell++] +=
            squared * weight[row] * Eigen::Vector3f(of[0][row], of[1][row], of[2][row]);
      }
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const auto& [of_cell, uv] = cells_[i];
      if (!(of_cell > 0.0f)) continue;
      samples[count++] = {uv, anchors.models().colour(anchor, uv) + left[i] / of_cell};
    }
    return samples.first(count);
  }

 private:
  struct Cell {
    float weight = 0;
    Eigen::Vector2f uv = Eigen::Vector2f::Zero();  ///< mean
  };

  static std::vector<Eigen::Vector2f> asked(const AnchoredOffsets& anchors, std::size_t anchor,
                                            std::span<const Follower> followers, const Given& given,
                                            const Residuals& residuals) {
    std::vector<Eigen::Vector2f> uvs;
    sparse::Column u, v;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
    for (const Follower& follower : followers) {
      const DirectionRows w = residuals.of(follower.triangle).w;
      const Eigen::Vector3f n =
          core::normal_on(given.mesh, follower.triangle, given.samples.middle(follower.triangle));
      asked_directions(anchors.asked_patch(anchor, n), w, u.row, v.row);
      for (std::size_t row = 0; row < w.count; ++row) uvs.emplace_back(u.row[row], v.row[row]);
    }
    return uvs;
  }

  /// Those of the grid's cells that are asked, in its order.
  void number(std::span<const Eigen::Vector2f> uvs, int grid) {
    std::array<std::uint8_t, kMostCells> number{};
    for (const Eigen::Vector2f& uv : uvs) number[cell_at(uv, grid)] = 1;
    std::uint8_t next = 0;
    for (std::uint8_t& of_cell : number) {
      if (of_cell != 0) of_cell = next++;
    }
    cells_.resize(next);
    of_sample_.reserve(uvs.size());
    for (const Eigen::Vector2f& uv : uvs) of_sample_.push_back(number[cell_at(uv, grid)]);
  }

  std::vector<Cell> cells_;
  std::vector<std::uint8_t> of_sample_;  ///< of the followers' rows
};

using Models = std::vector<sparse::PatchModel>;

/// Anchors on their way.
class AnchorFit {
 public:
  AnchorFit(const Given& given, AnchoredOffsets start, Residuals& residuals)
      : given_(given),
        residuals_(residuals),
        anchors_(std::move(start)),
        followers_(followers_of(anchors_, given.samples)),
        cells_(followers_.size()) {}

  /// Makes the residuals those of these anchors.
  void leave() {
    for (std::size_t level = 0; level < kSpacings.size(); ++level) {
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
    if (cells.empty()) cells = AskedCells(anchors_, anchor, followers, given_, residuals_);
    const auto samples = cells.read(anchors_, anchor, followers, residuals_, workspace.samples);
    sparse::PatchModel model;
    if (!samples.empty()) model = workspace.selection.choose(samples).model;
    if (model.term_count() == 1) model.coefficient[0].setZero();
    return model;
  }

  const Given& given_;
  Residuals& residuals_;
  AnchoredOffsets anchors_;
  std::vector<std::vector<Follower>> followers_;  ///< of every anchor
  std::vector<AskedCells> cells_;                 ///< of those that have been fitted
};

/// Asked in the directions that leave less after the first sweep.
AnchoredOffsets fitted(const Given& given, const std::vector<AnchorLevel>& levels,
                       Residuals& residuals, const IsEnough& is_enough) {
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
  Residuals residuals(samples, directions, threads);
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
