// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace sheen::core {

/// While one exists no other process writes to the folder, or the file, that asks for a lock, too:
/// `.lock` in it, or `.NAME.lock` beside it, is held by flock, which ends with the process however
/// it ends, and names its holder. One that a killed process left behind means nothing.
class FolderLock {
 public:
  /// Creates the folder where it is missing. Throws Error: bad_input when another process holds the
  /// lock (it names process and machine) or the folder cannot be written.
  explicit FolderLock(const std::filesystem::path& folder);
  /// Of one file, which is replaced by what is made of it.
  static FolderLock of_file(const std::filesystem::path& file);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  FolderLock(FolderLock&&) = delete;
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  FolderLock(std::filesystem::path lock, const std::filesystem::path& locked);

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace sheen::core
