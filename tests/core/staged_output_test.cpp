// SPDX-License-Identifier: MIT
#include "core/files/staged_output.h"

#include "core/diagnostics/error.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <iterator>

namespace sheen::core {
namespace {

using tests::read_file;
using tests::TemporaryFolder;
using tests::write_file;
namespace fs = std::filesystem;

std::ptrdiff_t entries_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(StagedOutput, LeavesTheOldFileWithoutCommit) {
  const TemporaryFolder folder;
  write_file(folder / "a.txt", "old");
  {
    const StagedOutput output(folder / "a.txt");
    write_file(output.path(), "new");
    EXPECT_EQ(output.path().extension(), ".txt");
    EXPECT_EQ(output.path().parent_path(), folder.path());
  }
  EXPECT_EQ(read_file(folder / "a.txt"), "old");
  EXPECT_EQ(entries_in(folder.path()), 1);
}

TEST(StagedOutput, ReplacesTheFileOnCommitAndMakesFolders) {
  const TemporaryFolder folder;
  for (const char* content : {"first", "second"}) {
    StagedOutput output(folder / "deep/er/a.txt");
    write_file(output.path(), content);
    output.commit();
    EXPECT_EQ(read_file(folder / "deep/er/a.txt"), content);
  }
  EXPECT_EQ(entries_in(folder / "deep/er"), 1);
}

TEST(StagedOutput, ReplacesAWholeFolderOnCommit) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "views");
  write_file(folder / "views" / "old.png", "old");
  {
    StagedOutput output(folder / "views/");
    fs::create_directory(output.path());
    write_file(output.path() / "new.png", "new");
    EXPECT_TRUE(fs::exists(folder / "views" / "old.png"));
    output.commit();
  }
  EXPECT_FALSE(fs::exists(folder / "views" / "old.png"));
  EXPECT_EQ(read_file(folder / "views" / "new.png"), "new");
  EXPECT_EQ(entries_in(folder.path()), 1);
}

TEST(StagedOutput, RemovesAnUnfinishedFolder) {
  const TemporaryFolder folder;
  {
    const StagedOutput output(folder / "views");
    fs::create_directories(output.path() / "deep");
  }
  EXPECT_EQ(entries_in(folder.path()), 0);
}

TEST(StagedOutput, TwoOfOneNameDoNotMeet) {
  const TemporaryFolder folder;
  const StagedOutput first(folder / "a");
  const StagedOutput second(folder / "a");
  EXPECT_NE(first.path(), second.path());
}

TEST(StagedOutput, NamesAPlaceThatCannotBeWritten) {
  const TemporaryFolder folder;
  write_file(folder / "file", "x");
  EXPECT_THROW(StagedOutput(folder / "file" / "a.txt"), Error);
  EXPECT_THROW(StagedOutput{fs::path("")}, Error);
  EXPECT_THROW(StagedOutput(folder / ".."), Error);
}

TEST(StagedOutput, CommitOfNothingFailsAndKeepsTheOldFile) {
  const TemporaryFolder folder;
  write_file(folder / "a.txt", "old");
  StagedOutput output(folder / "a.txt");
  try {
    output.commit();
    FAIL() << "nothing was written, yet commit succeeded";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::run_failed);
  }
  EXPECT_EQ(read_file(folder / "a.txt"), "old");
}

}  // namespace
}  // namespace sheen::core
