// SPDX-License-Identifier: MIT
#include "fitting/undo/sample_log.h"

#include "core/diagnostics/error.h"

#include <sys/types.h>

#include <cassert>
#include <filesystem>

namespace sheen::fitting {
namespace {

constexpr std::size_t kSampleBytes = sizeof(std::uint32_t) + 5 * sizeof(float);

core::Error failure(const char* fault) {
  return {core::Error::Kind::run_failed, std::filesystem::temp_directory_path(), fault,
          "free some space there or name another folder in TMPDIR"};
}

bool seek(std::FILE* file, std::size_t sample) {
  return fseeko(file, static_cast<off_t>(sample * kSampleBytes), SEEK_SET) == 0;
}

/// Every column of a batch, one after the other.
template <typename Batch, typename Transfer>
bool for_each_column(Batch& batch, const Transfer& transfer) {
  return transfer(batch.patch) && transfer(batch.u) && transfer(batch.v) && transfer(batch.r) &&
         transfer(batch.g) && transfer(batch.b);
}

}  // namespace

SampleLog::SampleLog() : file_(std::tmpfile()) {
  if (!file_) throw failure("takes no temporary file");
}

void SampleLog::append(const core::SampleBatch& batch) {
  const std::size_t begin = begin_of(size());
  // The data of an empty column may be a null pointer, which no file takes.
  const auto write = [this](const auto& column) {
    return column.empty() || std::fwrite(column.data(), sizeof(column[0]), column.size(),
                                         file_.get()) == column.size();
  };
  if (!seek(file_.get(), begin) || !for_each_column(batch, write) ||
      std::fflush(file_.get()) != 0) {
    throw failure("cannot hold the samples that undo needs");
  }
  ends_.push_back(begin + batch.size());
}

void SampleLog::truncate(std::size_t batches) {
  assert(batches <= size());
  ends_.resize(batches);
}

void SampleLog::read(std::size_t idx, core::SampleBatch& batch) const {
  assert(idx < size());
  const std::size_t count = ends_[idx] - begin_of(idx);
  const auto read_column = [&](auto& column) {
    column.resize(count);
    return count == 0 || std::fread(column.data(), sizeof(column[0]), count, file_.get()) == count;
  };
  if (!seek(file_.get(), begin_of(idx)) || !for_each_column(batch, read_column)) {
    throw failure("does not give back the samples that undo needs");
  }
}

}  // namespace sheen::fitting
