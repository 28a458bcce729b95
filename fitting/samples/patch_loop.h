// SPDX-License-Identifier: MIT
#pragma once

#include "core/concurrency/parallel_for.h"
#include "core/mesh/neighbours.h"
#include "core/samples/sample_batch.h"
#include "fitting/fitter.h"
#include "fitting/samples/change_list.h"
#include "fitting/samples/fit_outcome.h"
#include "fitting/samples/sample.h"
#include "fitting/unseen/fill_unseen.h"

#include <Eigen/Core>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace sheen::fitting {

/// What representations share whose patches are fitted independently: the threads, the statistics,
/// the list of changes and the colours of patches never seen. Updates are valid until the next
/// call.
class PatchLoop {
 public:
  /// `threads` >= 1.
  PatchLoop(const core::VertexNeighbours& neighbours, int threads)
      : neighbours_(neighbours), threads_(threads) {
    assert(threads >= 1);
  }

  [[nodiscard]] const FitStatistics& statistics() const { return statistics_; }

  /// Calls `integrate_one(patch_idx, sample)` for every usable sample of the batch; it returns a
  /// FitOutcome.
  template <typename AbsorbOne>
  const ModelUpdate& integrate(const core::SampleBatch& batch, const AbsorbOne& integrate_one) {
    return integrate(batch, integrate_one, [](std::size_t /*idx*/) {});
  }

  /// The same; `announce(idx)` is called a few samples ahead with the index of one to come, so that
  /// its memory can be fetched meanwhile.
  template <typename AbsorbOne, typename Announce>
  const ModelUpdate& integrate(const core::SampleBatch& batch, const AbsorbOne& integrate_one,
                               const Announce& announce) {
    constexpr std::size_t ahead = 3;
    changes_.reset(batch.size());
    // Patches are independent and appear once: any split of the batch gives the same result.
    run(batch.size(), [&](std::size_t i, std::size_t end, FitStatistics& statistics) {
      assert(batch.patch[i] < neighbours_.vertex_count());
      assert(i == 0 || batch.patch[i - 1] < batch.patch[i]);
      if (i + ahead < end) announce(i + ahead);  // beyond, another thread writes
      const auto sample = usable_sample(batch, i);
      if (!sample) return;
      const FitOutcome outcome = integrate_one(batch.patch[i], *sample);
      changes_.mark(i, outcome.changed);
      statistics.samples += 1;
      statistics.patch_views += 1;
      statistics.fits += outcome.fits;
    });
    changes_.list([&](std::size_t i) { return batch.patch[i]; }, update_);
    return update_;
  }

  /// Calls `solve(patch_idx)` for every patch, which returns a FitOutcome; then gives each patch
  /// whose `observed` flag is 0 the colour that the `colour_of(patch_idx)` of the seen ones
  /// suggest: `store_unseen(patch_idx, colour)` returns whether a stored number changed.
  template <typename Solve, typename ColourOf, typename StoreUnseen>
  const ModelUpdate& finish(const std::vector<std::uint8_t>& observed, const Solve& solve,
                            const ColourOf& colour_of, const StoreUnseen& store_unseen) {
    changes_.reset(observed.size());
    // Solve what was put off.
    run(observed.size(), [&](std::size_t patch, std::size_t /*end*/, FitStatistics& statistics) {
      const FitOutcome outcome = solve(patch);
      changes_.mark(patch, outcome.changed);
      statistics.fits += outcome.fits;
    });
    // Fill what nobody saw.
    std::vector<Eigen::Vector3f> colours(observed.size());
    for (std::size_t patch = 0; patch < colours.size(); ++patch) colours[patch] = colour_of(patch);
    fill_unseen(neighbours_, observed, colours);
    for (std::size_t patch = 0; patch < colours.size(); ++patch) {
      if (observed[patch] == 0) changes_.mark(patch, store_unseen(patch, colours[patch]));
    }
    changes_.list([](std::size_t patch) { return static_cast<std::uint32_t>(patch); }, update_);
    return update_;
  }

 private:
  // Calls body(idx, end, statistics) on all threads, each up to an `end` of its own, and adds up
  // the statistics.
  template <typename Body>
  void run(std::size_t count, const Body& body) {
    std::mutex mutex;
    core::parallel_for(count, threads_, [&](std::size_t begin, std::size_t end) {
      FitStatistics here;
      for (std::size_t i = begin; i < end; ++i) body(i, end, here);
      const std::lock_guard lock(mutex);
      statistics_.samples += here.samples;
      statistics_.patch_views += here.patch_views;
      statistics_.fits += here.fits;
    });
  }

  core::VertexNeighbours neighbours_;
  int threads_;
  FitStatistics statistics_;
  ChangeList changes_;
  ModelUpdate update_;
};

/// For representations that put nothing off: the `solve` of `PatchLoop::finish`.
inline FitOutcome nothing_to_solve(std::size_t /*patch_idx*/) {
  return {};
}

}  // namespace sheen::fitting
