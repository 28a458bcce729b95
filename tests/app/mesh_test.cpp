// SPDX-License-Identifier: MIT
// `sheen mesh` on the sample session, whose shape is known.
#include "core/files/folder_lock.h"
#include "core/mesh/bounds.h"
#include "core/mesh/read_mesh.h"
#include "tests/app/copied_session.h"

#include <unistd.h>

namespace sheen::tests {
namespace {

using MeshCommand = CopiedSession;

TEST_F(MeshCommand, LeavesAMeshThatIsThere) {
  const std::string before = read_file(session_ / "object.ply");
  const ProgramRun run = run_sheen({"mesh", session_});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.standard_error.find("is the session's mesh already; --force replaces it"),
            std::string::npos)
      << run.standard_error;
  const ProgramRun beside = run_sheen({"mesh", session_, "-o", session_ / "object.ply"});
  EXPECT_EQ(beside.exit_code, 2);
  EXPECT_EQ(read_file(session_ / "object.ply"), before);
}

TEST_F(MeshCommand, WhoeverWritesIntoASessionHasItAlone) {
  const std::string before = read_file(session_ / "session.json");
  {
    const core::FolderLock lock(session_);
    const std::string holder = "is in use by process " + std::to_string(getpid()) + " on ";
    for (const std::string command : {"mesh", "register", "survey"}) {
      std::vector<std::string> words{command, session_, "--quiet", "--end", "12"};
      if (command == "mesh") words.push_back("--force");
      const ProgramRun run = run_sheen(words);
      EXPECT_EQ(run.exit_code, 2) << command;
      EXPECT_NE(run.standard_error.find(holder), std::string::npos) << run.standard_error;
    }
    // To look at it is nobody's exclusive right, nor to write elsewhere.
    const ProgramRun beside = run_sheen(
        {"survey", session_, "--quiet", "--end", "12", "-o", folder_.path() / "board.yaml"});
    EXPECT_EQ(beside.exit_code, 0) << beside.standard_error;
  }
  EXPECT_EQ(read_file(session_ / "session.json"), before);
  EXPECT_FALSE(std::filesystem::exists(session_ / ".lock"));
  EXPECT_EQ(run_sheen({"survey", session_, "--quiet", "--end", "12"}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(session_ / ".lock"));
}

TEST_F(MeshCommand, MakesASessionWithoutAMeshOneThatReplays) {
  replace("session.json", R"(,\s*"object": \{[^}]*\})", "");
  std::filesystem::remove(session_ / "object.ply");
  const ProgramRun without = run_sheen({"survey", session_});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.standard_error.find("has no mesh of its object yet; make one: sheen mesh"),
            std::string::npos)
      << without.standard_error;

  const ProgramRun run = run_sheen({"mesh", session_, "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  // The knot is 140.4 x 138.6 x 87 mm on the board; a pixel is .66 mm, and outlines bound it from
  // outside.
  const auto size_mm = run.json()["size_mm"];
  EXPECT_NEAR(size_mm[0].get<double>(), 141, 3);
  EXPECT_NEAR(size_mm[1].get<double>(), 139, 3);
  EXPECT_NEAR(size_mm[2].get<double>(), 89, 5);
  EXPECT_GT(run.json()["covered_share"].get<double>(), 0.95);
  // Gloss moves no vertex: what other views would confirm of that is a fiftieth of the residual.
  EXPECT_EQ(run.json()["print_rounds"], 0);
  EXPECT_FALSE(std::filesystem::exists(session_ / "session.before-mesh.json"));  // none was there
  const ProgramRun replayed = run_sheen({"replay", session_, "-o", model_, "--end", "10"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.standard_error;
}

}  // namespace
}  // namespace sheen::tests
