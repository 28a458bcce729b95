// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/sample_batch.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace sheen::core {

/// The k-th of n contiguous shares of an object's patches, which differ by at most one patch;
/// 1 <= number <= of. All n are the object.
struct PatchShare {
  std::uint32_t number = 1;
  std::uint32_t of = 1;
  bool operator==(const PatchShare&) const = default;

  [[nodiscard]] bool is_whole() const { return of == 1; }

  /// The first patch of the share; that of the next one ends it.
  [[nodiscard]] std::size_t first(std::size_t patch_count) const {
    return patch_count * (number - 1) / of;
  }
  [[nodiscard]] std::size_t end(std::size_t patch_count) const { return patch_count * number / of; }

  /// Leaves the samples of the share's patches.
  void keep(std::size_t patch_count, SampleBatch& batch) const {
    if (is_whole()) return;
    const auto begin =
        std::ranges::lower_bound(batch.patch, first(patch_count)) - batch.patch.begin();
    const auto end_idx =
        std::ranges::lower_bound(batch.patch, end(patch_count)) - batch.patch.begin();
    const auto cut = [&](auto& column) {
      column.erase(column.begin() + end_idx, column.end());
      column.erase(column.begin(), column.begin() + begin);
    };
    cut(batch.patch);
    for (auto* column : {&batch.u, &batch.v, &batch.r, &batch.g, &batch.b}) cut(*column);
  }
};

}  // namespace sheen::core
