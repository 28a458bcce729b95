// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace sheen::fitting::sparse {

/// Sixteen samples, 12 bytes each, field by field: a search for the nearest direction reads one
/// cache line of three.
struct alignas(64) SampleBlock {
  static constexpr std::size_t kSamples = 16;
  std::array<std::int16_t, kSamples> u, v;      ///< in 1 / 32767
  std::array<std::uint16_t, kSamples> r, g, b;  ///< in 1 / 32767, from -0.5
  std::array<std::uint8_t, kSamples> count;     ///< samples averaged here, saturating
  std::array<std::uint8_t, kSamples>
      normalised_residual;  ///< how far off a prediction was, normalised_residual_code
};
static_assert(sizeof(SampleBlock) == 192);

/// Where all patches get their blocks from. Blocks are never given back. In slabs of huge pages:
/// the patches of a view lie all over it.
class SamplePool {
 public:
  /// Makes sure that `count` blocks can be taken. Not while others use the pool.
  void reserve(std::size_t count);
  /// The id (never 0) of a block with unspecified content; any thread. At most what was reserved.
  [[nodiscard]] std::uint32_t take() { return taken_.fetch_add(1, std::memory_order_relaxed); }

  [[nodiscard]] SampleBlock& operator[](std::uint32_t id) {
    return slabs_[id / kSlabBlocks].get()[id % kSlabBlocks];
  }
  [[nodiscard]] const SampleBlock& operator[](std::uint32_t id) const {
    return slabs_[id / kSlabBlocks].get()[id % kSlabBlocks];
  }

 private:
  static constexpr std::size_t kSlabBlocks = std::size_t{1} << 15;  // 6 MiB, three huge pages
  struct Free {
    void operator()(SampleBlock* blocks) const { std::free(blocks); }
  };
  std::vector<std::unique_ptr<SampleBlock[], Free>> slabs_;
  std::atomic<std::uint32_t> taken_{1};
};

}  // namespace sheen::fitting::sparse
