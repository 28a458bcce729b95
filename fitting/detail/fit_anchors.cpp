// SPDX-License-Identifier: MIT
#include "fitting/detail/fit_anchors.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/detail/detail_light_field.h"
#include "fitting/sparse/sample_store.h"
#include "fitting/sparse/workspaces.h"

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

namespace sheen::fitting::detail {
namespace {

constexpr int kSweeps = 3;

sparse::LightFieldModel zeros(std::size_t count) {
  return no_offsets(std::vector<std::uint8_t>(count, 1));
}

/// Vertices that blend each anchor, ascending.
class Followers {
 public:
  Followers(std::span<const AnchorBlend> blends, std::size_t anchor_count)
      : offsets_(anchor_count + 1, 0) {
    for_each(blends, [&](std::uint32_t anchor, std::uint32_t) { ++offsets_[anchor + 1]; });
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    vertices_.resize(offsets_.back());
    std::vector<std::size_t> next(offsets_.begin(), offsets_.end() - 1);
    for_each(blends, [&](std::uint32_t anchor, std::uint32_t vertex) {
      vertices_[next[anchor]++] = vertex;
    });
  }
  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t anchor) const {
    return std::span(vertices_).subspan(offsets_[anchor], offsets_[anchor + 1] - offsets_[anchor]);
  }

 private:
  template <typename Visit>
  static void for_each(std::span<const AnchorBlend> blends, const Visit& visit) {
    for (std::uint32_t vertex = 0; vertex < blends.size(); ++vertex) {
      for (std::size_t i = 0; i < kMostBlended && blends[vertex].weight[i] > 0.0f; ++i) {
        visit(blends[vertex].anchor[i], vertex);
      }
    }
  }

  std::vector<std::size_t> offsets_;
  std::vector<std::uint32_t> vertices_;
};

/// What anchors leave of the samples' differences from the means of their vertices.
class Residuals {
 public:
  Residuals(const sparse::SparseFitter& patches, int threads)
      : patches_(patches), threads_(threads), offsets_(1, 0) {
    for (std::size_t vertex = 0; vertex < patches.light_field().patch_count(); ++vertex) {
      offsets_.push_back(offsets_.back() + patches.samples_of(vertex).size());
    }
    left_.resize(offsets_.back());
  }

  /// Computes them anew; returns the weighted sum of their squares.
  double update(const AnchoredOffsets& anchors) {
    std::vector<double> squared(offsets_.size() - 1, 0.0);
    core::parallel_for(squared.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t vertex = begin; vertex < end; ++vertex) {
        squared[vertex] = update(anchors, vertex);
      }
    });
    return std::accumulate(squared.begin(), squared.end(), 0.0);
  }

  /// Those of a vertex, in the order of its samples.
  [[nodiscard]] std::span<const Eigen::Vector3f> of(std::size_t vertex) const {
    return std::span(left_).subspan(offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]);
  }

 private:
  double update(const AnchoredOffsets& anchors, std::size_t vertex) {
    Eigen::Vector3f* const left = left_.data() + offsets_[vertex];
    const std::vector<sparse::KeptSample> samples = patches_.samples_of(vertex);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float weight = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      left[i] = samples[i].sample.rgb - anchors.colour(vertex, samples[i].sample.uv);
      sum += samples[i].weight * left[i];
      weight += samples[i].weight;
    }
    if (!(weight > 0.0f)) return 0;
    double squared = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      left[i] -= sum / weight;
      squared += static_cast<double>(samples[i].weight * left[i].squaredNorm());
    }
    return squared;
  }

  const sparse::SparseFitter& patches_;
  int threads_;
  std::vector<std::size_t> offsets_;
  std::vector<Eigen::Vector3f> left_;
};

/// What all anchors are fitted from.
struct Given {
  const core::Mesh& mesh;
  const sparse::SparseFitter& patches;
  const sparse::Options& options;
  int threads;
};

/// Every anchor anew, towards its own value and what all together left.
void sweep(const Given& given, const Residuals& residuals, const Followers& followers,
           AnchoredOffsets& anchors) {
  const std::size_t count = anchors.layout().vertices.size();
  sparse::LightFieldModel next = zeros(count);
  sparse::Workspaces workspaces(given.options);
  const float tolerance =
      given.patches.statistics().tolerance.value_or(sparse::kToleranceOfUnknownNoise);
  const auto most = static_cast<std::size_t>(given.options.max_samples);
  core::parallel_for(
      count, given.threads,
      [&](std::size_t begin, std::size_t end) {
        sparse::SamplePool pool;
        pool.reserve((end - begin) * (most / sparse::SampleBlock::kSamples + 1));
        workspaces.with_one([&](sparse::Workspace& workspace) {
          workspace.selection.set_tolerance(tolerance);
          for (std::size_t anchor = begin; anchor < end; ++anchor) {
            sparse::SampleStore store;
            for (const std::uint32_t vertex : followers.of(anchor)) {
              const auto left = residuals.of(vertex);
              const auto samples = given.patches.samples_of(vertex);
              for (std::size_t i = 0; i < samples.size(); ++i) {
                const Eigen::Vector2f uv = anchors.uv_at(anchor, vertex, samples[i].sample.uv);
                store.add({uv, anchors.models().colour(anchor, uv) + left[i]}, most, pool);
              }
            }
            if (store.size() == 0) continue;
            const auto chosen = workspace.selection.choose(store.read(pool, workspace.samples));
            if (chosen.model.term_count() > 1) next.store(anchor, chosen.model);
          }
        });
      },
      16);
  anchors.models() = std::move(next);
}

/// Anchors after some sweeps.
struct Swept {
  AnchoredOffsets anchors;
  double squared;  ///< what they leave
};

Swept swept(const Given& given, AnchoredOffsets anchors, int sweeps, Residuals& residuals) {
  const Followers followers(anchors.blends(), anchors.layout().vertices.size());
  double squared = residuals.update(anchors);
  for (int i = 0; i < sweeps; ++i) {
    sweep(given, residuals, followers, anchors);
    squared = residuals.update(anchors);
  }
  return {std::move(anchors), squared};
}

/// Asked in the directions that leave less after the first sweep.
AnchoredOffsets fitted(const Given& given, const AnchorLayout& layout, Residuals& residuals) {
  const auto first = [&](AskedDirection asked) {
    return swept(given, {given.mesh, layout, asked, zeros(layout.vertices.size())}, 1, residuals);
  };
  Swept same = first(AskedDirection::same);
  Swept mirrored = first(AskedDirection::mirrored);
  Swept& better = mirrored.squared < same.squared ? mirrored : same;
  return swept(given, std::move(better.anchors), kSweeps - 1, residuals).anchors;
}

/// Without those that only blend with zeros.
std::shared_ptr<const AnchoredOffsets> without_idle(const core::Mesh& mesh,
                                                    const AnchoredOffsets& anchors) {
  // Mark what vertices need that differ from zero.
  const AnchorLayout& layout = anchors.layout();
  std::vector<std::uint8_t> is_needed(layout.vertices.size(), 0);
  for (const AnchorBlend& blend : anchors.blends()) {
    bool differs = false;
    for (std::size_t i = 0; i < kMostBlended && blend.weight[i] > 0.0f; ++i) {
      differs = differs || anchors.models().term_count(blend.anchor[i]) > 1;
    }
    for (std::size_t i = 0; differs && i < kMostBlended && blend.weight[i] > 0.0f; ++i) {
      is_needed[blend.anchor[i]] = 1;
    }
  }
  // Take it.
  AnchorLayout needed{{}, layout.spacing_m};
  std::vector<std::size_t> from;
  for (std::size_t i = 0; i < is_needed.size(); ++i) {
    if (is_needed[i] == 0) continue;
    needed.vertices.push_back(layout.vertices[i]);
    from.push_back(i);
  }
  if (from.empty()) return nullptr;
  sparse::LightFieldModel models = zeros(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    models.store(i, anchors.models().patch(from[i]));
  }
  return std::make_shared<const AnchoredOffsets>(mesh, std::move(needed), anchors.asked(),
                                                 std::move(models));
}

Eigen::Vector3f mean_over_views(const AnchoredOffsets& anchors, std::size_t vertex,
                                std::span<const sparse::KeptSample> samples) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weight = 0;
  for (const sparse::KeptSample& kept : samples) {
    sum += kept.weight * anchors.colour(vertex, kept.sample.uv);
    weight += kept.weight;
  }
  return weight > 0.0f ? Eigen::Vector3f(sum / weight) : Eigen::Vector3f::Zero();
}

}  // namespace

FittedAnchors fit_anchors(const core::Mesh& mesh, const sparse::SparseFitter& patches,
                          float spacing_m, const sparse::Options& options, int threads) {
  const Given given{mesh, patches, options, threads};
  const AnchorLayout layout{scatter_anchors(mesh, spacing_m), spacing_m};
  Residuals residuals(patches, threads);
  const AnchoredOffsets anchors = fitted(given, layout, residuals);
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
