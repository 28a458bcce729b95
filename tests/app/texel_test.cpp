// SPDX-License-Identifier: MIT
// Texel patches against vertex patches: what detail between the vertices of a mesh is worth.
#include "tests/app/program.h"

#include <gtest/gtest.h>

namespace sheen::tests {
namespace {

double psnr(const nlohmann::json& error) {
  return error.at("psnr").get<double>();
}

TEST(TexelPatches, ShowPrintFinerThanTheMesh) {
  // A knot of 20 thousand vertices is photographed, the session knows 3000 of them: 4 mm apart,
  // under a print of lines 0.6 mm wide and 3 mm apart.
  const TemporaryFolder folder;
  const auto session = folder.path() / "textured";
  const ProgramRun synth = run_sheen({"synth", "textured", "-o", session, "--size", "480x270",
                                      "--frames", "40", "--held-out", "4", "--samples", "2",
                                      "--vertices", "20000", "--mesh-vertices", "3000", "--quiet"});
  ASSERT_EQ(synth.exit_code, 0) << synth.standard_error;
  const auto held_out_psnr = [&](const std::string& patches) {
    const auto model = folder.path() / (patches + ".glb");
    const ProgramRun replay =
        run_sheen({"replay", session, "-o", model, "--patches", patches, "--quiet"});
    EXPECT_EQ(replay.exit_code, 0) << replay.standard_error;
    const ProgramRun evaluation =
        run_sheen({"evaluate", model, session / "held_out", "--json", "--quiet"});
    EXPECT_EQ(evaluation.exit_code, 0) << evaluation.standard_error;
    return psnr(evaluation.json()["mean"]);
  };
  EXPECT_GE(held_out_psnr("texel"), held_out_psnr("vertex") + 3.0);
}

TEST(TexelPatches, ShowThePrintOfTheBox) {
  const auto session = shared_session("box");
  if (session.empty()) GTEST_SKIP() << "box is not here";
  const TemporaryFolder folder;
  const auto held_out_psnr = [&](const std::string& patches) {
    const ProgramRun run =
        run_sheen({"replay", session, "-o", folder.path() / "model.glb", "--hold-out", "5",
                   "--patches", patches, "--json", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.standard_error;
    return psnr(run.json()["held_out"]);
  };
  EXPECT_GE(held_out_psnr("texel"), held_out_psnr("vertex") + 1.5);
}

}  // namespace
}  // namespace sheen::tests
