// SPDX-License-Identifier: MIT
// A session with depth images, from its files to the quads.
#include "capture/session/session.h"
#include "capture/synthetic/synthetic_session.h"
#include "fitting/depth_quads/depth_quads.h"
#include "pipeline/reconstruct.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace sheen::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr double kUnit_m = 1e-4;  // of what is synthesised at this size

/// A few frames with depth images; poses are the true ones.
class DepthSession : public testing::Test {
 protected:
  void SetUp() override {
    capture::synthetic::SyntheticOptions options;
    options.vertices = 4000;
    options.width_px = 320;
    options.height_px = 180;
    options.frames = 8;
    options.held_out = 0;
    options.samples = 1;
    options.depth = true;
    capture::synthetic::write_synthetic_session(folder(), options, {});
    change([](nlohmann::json& session) { session["poses"] = "truth_poses.txt"; });
  }

  [[nodiscard]] fs::path folder() const { return scratch_.path() / "session"; }

  template <typename Change>
  void change(const Change& change) const {
    const fs::path file = folder() / "session.json";
    auto session = nlohmann::json::parse(tests::read_file(file));
    change(session);
    tests::write_file(file, session.dump());
  }

  [[nodiscard]] Reconstruction fitted(const std::string& depths, ProgressSink& sink) const {
    return reconstruct({.session = capture::open_session(folder())},
                       {.representation = "depth-quads",
                        .fit = {{"depths", depths}, {"median", "1"}},
                        .patches = Patches::vertex},
                       sink);
  }

 private:
  tests::TemporaryFolder scratch_;
};

const fitting::depth_quads::DepthQuads& quads_of(const Reconstruction& fitted) {
  return dynamic_cast<const fitting::depth_quads::DepthQuads&>(fitted.light_field());
}

// Files hold the truth to half a step of .1 mm, traced through the lens; the z-buffer joins the
// projected vertices by straight lines, which over an edge of 4 pixels the barrel bends by
// thousandths of one. So no more than cells whose middle lies on an outline, where two surfaces
// meet, differ.
TEST_F(DepthSession, QuadsFromFilesAreThoseFromTheMesh) {
  ProgressSink sink;
  const Reconstruction from_files = fitted("session", sink), from_mesh = fitted("mesh", sink);
  EXPECT_TRUE(from_files.findings().empty() || from_files.findings().front().cause != "depth-unit");
  ASSERT_EQ(quads_of(from_files).element_count(), quads_of(from_mesh).element_count());
  std::size_t cells = 0, differing = 0;
  for (std::size_t i = 0; i < quads_of(from_mesh).element_count(); ++i) {
    const auto& files = quads_of(from_files).quads(i).depths;
    const auto& mesh = quads_of(from_mesh).quads(i).depths;
    ASSERT_EQ(files.codes.size(), mesh.codes.size());
    const double step_m = static_cast<double>(std::max(files.farthest_m - files.nearest_m,
                                                       mesh.farthest_m - mesh.nearest_m)) /
                          65534;
    for (std::size_t k = 0; k < mesh.codes.size(); ++k) {
      if (mesh.codes[k] == 0) continue;
      ++cells;
      if (files.codes[k] == 0 || std::abs(static_cast<double>(files.depth_m(files.codes[k]) -
                                                              mesh.depth_m(mesh.codes[k]))) >
                                     kUnit_m / 2 + step_m + 2e-5) {
        ++differing;
      }
    }
  }
  const double part = static_cast<double>(differing) / static_cast<double>(cells);
  std::printf("%zu of %zu cells differ: %.4f\n", differing, cells, part);
  EXPECT_GT(cells, 8u * 500u);
  EXPECT_LT(part, 0.02);
}

// Steps of .1 m instead of .1 mm.
TEST_F(DepthSession, AWrongUnitIsSaid) {
  change([](nlohmann::json& session) { session["depth"]["unit_m"] = 1000 * kUnit_m; });
  ProgressSink sink;
  const Reconstruction wrong = fitted("session", sink);
  const auto found = std::ranges::find(wrong.findings(), "depth-unit", &Finding::cause);
  ASSERT_NE(found, wrong.findings().end());
  EXPECT_NE(found->line.find("1e+03 times"), std::string::npos) << found->line;
  EXPECT_NE(found->line.find("0.0001 would fit"), std::string::npos) << found->line;
}

// Nobody who does not want depth images reads them.
TEST_F(DepthSession, AMissingImageIsNamedWhereItIsWanted) {
  fs::remove(folder() / "depth" / "0007.png");
  ProgressSink sink;
  capture::test::expect_bad_input([&] { static_cast<void>(fitted("session", sink)); }, "0007.png",
                                  "frame 7");
  EXPECT_EQ(quads_of(fitted("mesh", sink)).element_count(), 8u);
}

}  // namespace
}  // namespace sheen::pipeline
