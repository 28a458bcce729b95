// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/sample_store.h"
#include "fitting/sparse/selection.h"

#include <array>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace sheen::fitting::sparse {

/// Scratch of one thread.
struct Workspace {
  explicit Workspace(const Options& options) : selection(options) {}
  Selection selection;
  std::array<DirectedColour, kMaxStoredSamples> samples;
};

/// Lends scratch to threads, as many as ever work at the same time.
class Workspaces {
 public:
  explicit Workspaces(const Options& options) : options_(options) {}

  /// Calls `body(workspace)`; any thread.
  template <typename Body>
  void with_one(const Body& body) {
    std::unique_ptr<Workspace> workspace = borrow();
    body(*workspace);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(workspace));
  }

 private:
  std::unique_ptr<Workspace> borrow() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Workspace> workspace = std::move(idle_.back());
        idle_.pop_back();
        return workspace;
      }
    }
    return std::make_unique<Workspace>(options_);
  }

  Options options_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> idle_;
};

}  // namespace sheen::fitting::sparse
