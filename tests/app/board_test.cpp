// SPDX-License-Identifier: MIT
// `sheen board`: the two files and what is refused.
#include "capture/pose/board.h"

#include "tests/app/program.h"

#include <gtest/gtest.h>

namespace sheen::tests {
namespace {

TEST(BoardCommand, WritesThePdfAndTheBoardBesideIt) {
  const TemporaryFolder folder;
  const auto pdf = folder.path() / "stage.pdf";
  const ProgramRun run = run_sheen({"board", "-o", pdf, "--measured-mm", "153", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_EQ(read_file(pdf).substr(0, 5), "%PDF-");
  const auto board = capture::read_board(folder.path() / "stage.yaml");
  EXPECT_EQ(board.tags.size(), run.json()["tags"].get<std::size_t>());
  // 153 mm instead of 150: 2 % larger than the 30 mm designed.
  EXPECT_NEAR(board.tags.at(500).size_m, 0.0306, 1e-9);
}

TEST(BoardCommand, RefusesTagsThatNoSheetHolds) {
  const TemporaryFolder folder;
  const ProgramRun run = run_sheen({"board", "-o", folder.path() / "stage.pdf", "--tag-mm", "220"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.standard_error.find("tag-mm"), std::string::npos) << run.standard_error;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace sheen::tests
