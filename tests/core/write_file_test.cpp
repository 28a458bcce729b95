// SPDX-License-Identifier: MIT
#include "core/files/write_file.h"

#include "core/diagnostics/error.h"
#include "tests/support/full_disk.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sheen::core {
namespace {

using tests::read_file;

/// Writes and returns what kind of error that was; nothing when it went well.
std::optional<Error::Kind> fault_of_writing(const std::filesystem::path& path,
                                            const std::string& bytes) {
  try {
    write_file(path, bytes);
    return std::nullopt;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(path.filename().string()), std::string::npos)
        << error.what();
    return error.kind();
  }
}

TEST(WriteFile, ReplacesTheWholeFile) {
  const tests::TemporaryFolder folder;
  for (const std::string& bytes : {std::string("a long first one"), std::string("short"),
                                   std::string("\0\n\r\n\xff", 5), std::string()}) {
    write_file(folder / "deep/er/file", bytes);
    EXPECT_EQ(read_file(folder / "deep/er/file"), bytes);
  }
}

// One byte too many is found when the stream is emptied at the end, a million while writing.
TEST(WriteFile, LeavesTheOldFileWhenTheDiskIsFull) {
  constexpr std::size_t room = 1000;
  const tests::TemporaryFolder folder;
  const auto path = folder.write("file", "old");
  for (const std::size_t size : {room + 1, std::size_t{1} << 20}) {
    std::optional<Error::Kind> fault;
    {
      const tests::FullDisk full(room);
      fault = fault_of_writing(path, std::string(size, 'x'));
    }
    EXPECT_EQ(fault, Error::Kind::run_failed) << size;
    EXPECT_EQ(read_file(path), "old") << size;
  }
  // What fits is written, and nothing half-written is left.
  const tests::FullDisk full(room);
  EXPECT_FALSE(fault_of_writing(path, std::string(room, 'x')));
  EXPECT_EQ(read_file(path), std::string(room, 'x'));
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(WriteFile, RefusesPlacesThatAreNone) {
  const tests::TemporaryFolder folder;
  folder.write("file", "old");
  EXPECT_EQ(fault_of_writing(folder / "file/below", "new"), Error::Kind::bad_input);
  EXPECT_EQ(read_file(folder / "file"), "old");
}

}  // namespace
}  // namespace sheen::core
