// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace sheen::core {

/// A file or folder that is written beside its final name and moved into place by `commit`. Without
/// a commit (an exception, an interrupted run) what was there before stays untouched and the
/// unfinished output is removed.
class StagedOutput {
 public:
  /// Creates missing parent folders. Throws Error (bad_input) when the place cannot be written.
  explicit StagedOutput(std::filesystem::path final_path);
  ~StagedOutput();
  StagedOutput(const StagedOutput&) = delete;
  StagedOutput& operator=(const StagedOutput&) = delete;
  StagedOutput(StagedOutput&&) = delete;
  StagedOutput& operator=(StagedOutput&&) = delete;

  /// Where to write: same folder, same extension, a name of its own. Not yet created.
  [[nodiscard]] const std::filesystem::path& path() const { return staged_path_; }

  /// Replaces the final path by the staged one in one move (a folder: old one aside, new one in,
  /// old one deleted). Throws Error (run_failed) when that fails.
  void commit();

 private:
  std::filesystem::path final_path_;
  std::filesystem::path staged_path_;
};

/// Throws Error (bad_input) when nothing can be written at `path`: asked before long work, so that
/// a mistyped folder costs seconds and not the whole fit. Leaves nothing behind.
void check_writable(const std::filesystem::path& path);

}  // namespace sheen::core
