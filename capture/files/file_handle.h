// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace sheen::capture {

/// An open regular file; closed at the end. Unlike a stream it reports a full disk at the write
/// that hits it, and can be flushed to the disk from another thread.
class FileHandle {
 public:
  /// Throws core::Error (bad_input) when there is no such regular file or it cannot be read.
  static FileHandle open_to_read(const std::filesystem::path& path);
  /// Makes a new file. Throws core::Error (bad_input) when it exists or cannot be made.
  static FileHandle create(const std::filesystem::path& path);

  FileHandle(FileHandle&& other) noexcept;
  FileHandle& operator=(FileHandle&& other) noexcept;
  FileHandle(const FileHandle&) = delete;
  FileHandle& operator=(const FileHandle&) = delete;
  ~FileHandle();

  /// Bytes from `offset` on; fewer than asked for at the end of the file or after a fault.
  [[nodiscard]] std::size_t read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const;

  /// Writes all of `bytes` at `offset`; 0, or the errno that stopped it.
  [[nodiscard]] int write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes);

  /// Cuts the file to `size` bytes; what cannot be cut stays.
  void truncate(std::uint64_t size);

  /// Waits until what was written lies on the disk; 0 or errno. May be called while another thread
  /// writes.
  [[nodiscard]] int flush() const;

  [[nodiscard]] std::uint64_t size() const;

 private:
  explicit FileHandle(int descriptor) : descriptor_(descriptor) {}

  int descriptor_ = -1;
};

}  // namespace sheen::capture
