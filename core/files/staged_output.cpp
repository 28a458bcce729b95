// SPDX-License-Identifier: MIT
#include "core/files/staged_output.h"

#include "core/diagnostics/error.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

namespace sheen::core {
namespace {

namespace fs = std::filesystem;

/// A hidden sibling of `path` that no other run and no other output of this run uses. The
/// extension stays, because writers choose the format by it.
fs::path sibling(const fs::path& path, const std::string& purpose) {
  static std::atomic<unsigned> counter{0};
  std::ostringstream name;
  name << '.' << path.stem().string() << '.' << purpose << '-' << getpid() << '-' << counter++
       << path.extension().string();
  return path.parent_path() / name.str();
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

std::error_code last_failure() {
  return {errno, std::generic_category()};
}

Error cannot_replace(const fs::path& path, const std::error_code& cause) {
  return {Error::Kind::run_failed, path, "cannot be moved into place (" + cause.message() + ")",
          "check free space and permissions of its folder"};
}

/// What a power cut must not take: contents reach the disk before their name does. Links are none
/// of ours.
std::error_code flush(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return errno == ELOOP ? std::error_code() : last_failure();
  // File systems that cannot flush a folder say so by EINVAL.
  const bool is_flushed = fsync(file) == 0 || errno == EINVAL;
  const std::error_code failure = is_flushed ? std::error_code() : last_failure();
  close(file);
  return failure;
}

std::error_code flush_all(const fs::path& path) {
  std::error_code failure;
  if (fs::is_directory(path, failure)) {
    for (fs::recursive_directory_iterator entry(path, failure), end; !failure && entry != end;
         entry.increment(failure)) {
      if (entry->is_symlink(failure)) continue;
      if (const auto fault = flush(entry->path())) return fault;
    }
  }
  return failure ? failure : flush(path);
}

/// A folder cannot be renamed over a folder that is not empty: step aside, move in, clear away.
void replace_folder(const fs::path& staged, const fs::path& final_path) {
  std::error_code failure;
  const bool had_old = fs::exists(final_path, failure);
  const fs::path old = sibling(final_path, "old");
  if (had_old) {
    fs::rename(final_path, old, failure);
    if (failure) throw cannot_replace(final_path, failure);
  }
  fs::rename(staged, final_path, failure);
  std::error_code ignored;
  if (failure) {
    if (had_old) fs::rename(old, final_path, ignored);
    throw cannot_replace(final_path, failure);
  }
  if (had_old) fs::remove_all(old, ignored);
}

}  // namespace

StagedOutput::StagedOutput(std::filesystem::path final_path) : final_path_(std::move(final_path)) {
  // "out/" and "out" name the same folder.
  if (!final_path_.has_filename()) final_path_ = final_path_.parent_path();
  if (!final_path_.has_filename() || final_path_.filename() == "." ||
      final_path_.filename() == "..") {
    throw bad_input(final_path_, "is not a name for an output", "give a file or folder name");
  }
  const fs::path parent = folder_of(final_path_);
  std::error_code failure;
  fs::create_directories(parent, failure);
  if (!fs::is_directory(parent, failure)) {
    throw bad_input(final_path_, "its folder cannot be created",
                    "choose a place where folders may be made");
  }
  if (access(parent.c_str(), W_OK | X_OK) != 0) {
    throw bad_input(final_path_, "its folder is not writable", "choose another place");
  }
  staged_path_ = sibling(final_path_, "partial");
}

StagedOutput::~StagedOutput() {
  // After a commit there is nothing left under this name.
  std::error_code ignored;
  fs::remove_all(staged_path_, ignored);
}

void StagedOutput::commit() {
  if (const auto failure = flush_all(staged_path_)) throw cannot_replace(final_path_, failure);
  std::error_code failure;
  if (fs::is_directory(staged_path_, failure)) {
    replace_folder(staged_path_, final_path_);
  } else {
    fs::rename(staged_path_, final_path_, failure);
    if (failure) throw cannot_replace(final_path_, failure);
  }
  // The name, too, where the file system can; the output stands in its place either way.
  static_cast<void>(flush(folder_of(final_path_)));
}

void check_writable(const std::filesystem::path& path) {
  const StagedOutput probe(path);
  if (!std::ofstream(probe.path())) {
    throw bad_input(path, "cannot be written", "check the folder and its permissions");
  }
}

}  // namespace sheen::core
