// SPDX-License-Identifier: MIT
// `sheen mesh` on the sample session, whose shape is known.
#include "core/mesh/bounds.h"
#include "core/mesh/read_mesh.h"
#include "tests/app/copied_session.h"

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
  const ProgramRun replayed = run_sheen({"replay", session_, "-o", model_, "--end", "10"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.standard_error;
}

}  // namespace
}  // namespace sheen::tests
