// SPDX-License-Identifier: MIT
#include "core/files/staged_output.h"

#include "core/diagnostics/error.h"
#include "tests/core/temp_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <iterator>

namespace sheen::core {
namespace {

using testing::read_bytes;
using testing::TempFolder;
using testing::write_bytes;
namespace fs = std::filesystem;

std::ptrdiff_t entries_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(StagedOutput, LeavesTheOldFileWithoutCommit) {
  const TempFolder folder;
  write_bytes(folder / "a.txt", "old");
  {
    const StagedOutput output(folder / "a.txt");
    write_bytes(output.path(), "new");
    EXPECT_EQ(output.path().extension(), ".txt");
    EXPECT_EQ(output.path().parent_path(), folder.path());
  }
  EXPECT_EQ(read_bytes(folder / "a.txt"), "old");
  EXPECT_EQ(entries_in(folder.path()), 1);
}

TEST(StagedOutput, ReplacesTheFileOnCommitAndMakesFolders) {
  const TempFolder folder;
  for (const char* content : {"first", "second"}) {
    StagedOutput output(folder / "deep/er/a.txt");
    write_bytes(output.path(), content);
    output.commit();
    EXPECT_EQ(read_bytes(folder / "deep/er/a.txt"), content);
  }
  EXPECT_EQ(entries_in(folder / "deep/er"), 1);
}

TEST(StagedOutput, ReplacesAWholeFolderOnCommit) {
  const TempFolder folder;
  fs::create_directory(folder / "views");
  write_bytes(folder / "views" / "old.png", "old");
  {
    StagedOutput output(folder / "views/");
    fs::create_directory(output.path());
    write_bytes(output.path() / "new.png", "new");
    EXPECT_TRUE(fs::exists(folder / "views" / "old.png"));
    output.commit();
  }
  EXPECT_FALSE(fs::exists(folder / "views" / "old.png"));
  EXPECT_EQ(read_bytes(folder / "views" / "new.png"), "new");
  EXPECT_EQ(entries_in(folder.path()), 1);
}

TEST(StagedOutput, RemovesAnUnfinishedFolder) {
  const TempFolder folder;
  {
    const StagedOutput output(folder / "views");
    fs::create_directories(output.path() / "deep");
  }
  EXPECT_EQ(entries_in(folder.path()), 0);
}

TEST(StagedOutput, TwoOfOneNameDoNotMeet) {
  const TempFolder folder;
  const StagedOutput first(folder / "a");
  const StagedOutput second(folder / "a");
  EXPECT_NE(first.path(), second.path());
}

TEST(StagedOutput, NamesAPlaceThatCannotBeWritten) {
  const TempFolder folder;
  write_bytes(folder / "file", "x");
  EXPECT_THROW(StagedOutput(folder / "file" / "a.txt"), Error);
  EXPECT_THROW(StagedOutput{fs::path("")}, Error);
  EXPECT_THROW(StagedOutput(folder / ".."), Error);
}

TEST(StagedOutput, CommitOfNothingFailsAndKeepsTheOldFile) {
  const TempFolder folder;
  write_bytes(folder / "a.txt", "old");
  StagedOutput output(folder / "a.txt");
  try {
    output.commit();
    FAIL() << "nothing was written, yet commit succeeded";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::run_failed);
  }
  EXPECT_EQ(read_bytes(folder / "a.txt"), "old");
}

}  // namespace
}  // namespace sheen::core
