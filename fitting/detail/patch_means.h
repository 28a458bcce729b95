// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/sample_batch.h"
#include "fitting/detail/weighted_mean.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting::detail {

/// What the views showed of every patch on average, to notice when what was computed from the views
/// of a patch, all of them, has become stale.
class PatchMeans {
 public:
  explicit PatchMeans(std::size_t patch_count) : means_(patch_count) {}

  /// Adds the samples of a view.
  void integrate(const core::SampleBatch& samples);

  /// Patches of the last view whose mean has moved visibly since they were taken, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& moved() const { return moved_; }

  /// What is computed from the patch's views is up to date. Different patches may be named by
  /// different threads.
  void set_taken(std::size_t patch_idx);

 private:
  struct Mean {
    WeightedMean of_views;
    Eigen::Vector3f taken = Eigen::Vector3f::Zero();
  };

  std::vector<Mean> means_;
  std::vector<std::uint32_t> moved_;
};

}  // namespace sheen::fitting::detail
