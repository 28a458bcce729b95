// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/fitter.h"

#include <cstdint>
#include <mutex>
#include <vector>

namespace sheen::pipeline {

/// The light field under construction, between the thread that fits it and those that look at it
/// meanwhile. All members may be called from any thread.
class SharedModel {
 public:
  /// The fitter is borrowed.
  explicit SharedModel(fitting::Fitter& fitter)
      : fitter_(fitter), is_changed_(fitter.light_field().element_count(), 0) {}

  /// Runs `work(fitter)` while nobody else has it.
  template <typename Work>
  decltype(auto) with(const Work& work) {
    const std::lock_guard lock(mutex_);
    return work(fitter_);
  }

  /// Runs `work(fitter, changes)` with what changed since such a look was last had, unless
  /// somebody else has the model right now; returns whether it ran.
  template <typename Work>
  bool try_look(const Work& work) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock.owns_lock()) work(fitter_, collect_changes());
    return lock.owns_lock();
  }

  void integrate(const core::Observation& observation) {
    const std::lock_guard lock(mutex_);
    note(fitter_.integrate(observation));
  }

  void finish() {
    const std::lock_guard lock(mutex_);
    note(fitter_.finish());
  }

 private:
  fitting::ModelUpdate collect_changes();
  void note(const fitting::ModelUpdate& update);

  std::mutex mutex_;
  fitting::Fitter& fitter_;
  std::vector<std::uint8_t> is_changed_;  ///< by element
};

}  // namespace sheen::pipeline
