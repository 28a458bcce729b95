// SPDX-License-Identifier: MIT
#include "fitting/sparse/sample_pool.h"

#include <sys/mman.h>

#include <new>

namespace sheen::fitting::sparse {

void SamplePool::reserve(std::size_t count) {
  constexpr std::size_t huge_page = std::size_t{2} << 20;
  constexpr std::size_t bytes = kSlabBlocks * sizeof(SampleBlock);
  static_assert(bytes % huge_page == 0);
  while (slabs_.size() * kSlabBlocks < taken_.load(std::memory_order_relaxed) + count) {
    void* slab = std::aligned_alloc(huge_page, bytes);
    if (slab == nullptr) throw std::bad_alloc();
    // Advice only: without huge pages everything works, slower.
    static_cast<void>(madvise(slab, bytes, MADV_HUGEPAGE));
    slabs_.emplace_back(static_cast<SampleBlock*>(slab));
  }
}

}  // namespace sheen::fitting::sparse
