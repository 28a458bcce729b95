// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/sample_batch.h"

#include <cstddef>
#include <cstdio>
#include <memory>
#include <vector>

namespace sheen::fitting {

/// Batches in the order in which they came, bit for bit, in a temporary file without a name: 24
/// bytes a sample on disk, next to nothing in memory. One thread at a time.
class SampleLog {
 public:
  /// Throws core::Error (run_failed) when no temporary file can be made.
  SampleLog();

  /// Throws core::Error (run_failed) when the disk is full; the log is then as before.
  void append(const core::SampleBatch& batch);
  /// Forgets all but the first `batches`.
  void truncate(std::size_t batches);
  [[nodiscard]] std::size_t size() const { return ends_.size(); }

  /// Replaces `batch` by the batch of this number, < size(). Throws core::Error (run_failed).
  void read(std::size_t idx, core::SampleBatch& batch) const;

 private:
  struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  [[nodiscard]] std::size_t begin_of(std::size_t idx) const {
    return idx == 0 ? 0 : ends_[idx - 1];
  }

  std::unique_ptr<std::FILE, FileCloser> file_;
  std::vector<std::size_t> ends_;  ///< samples up to and with each batch
};

}  // namespace sheen::fitting
