// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/fitter.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting {

/// Collects which entries changed while several threads work, and lists them in order afterwards.
class ChangeList {
 public:
  void reset(std::size_t count) { flags_.assign(count, 0); }
  /// Different entries may be marked by different threads.
  void mark(std::size_t idx, bool changed) {
    if (changed) flags_[idx] = 1;
  }
  /// Replaces `update` by the marked entries; `patch_of` turns an entry's index into its patch.
  template <typename PatchOf>
  void list(const PatchOf& patch_of, ModelUpdate& update) const {
    update.elements.clear();
    for (std::size_t i = 0; i < flags_.size(); ++i) {
      if (flags_[i] != 0) update.elements.push_back(patch_of(i));
    }
  }

 private:
  std::vector<std::uint8_t> flags_;
};

}  // namespace sheen::fitting
