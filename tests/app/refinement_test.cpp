// SPDX-License-Identifier: MIT
// What `replay` adjusts by itself: the board, the poses, the exposure, the mesh.
#include "capture/pose/board.h"
#include "capture/pose/trajectory.h"
#include "pipeline/reconstruct.h"
#include "tests/app/copied_session.h"
#include "tests/app/program.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <random>

namespace sheen::tests {
namespace {

/// The sample session with every tag of its board.yaml displaced by about half a millimetre.
std::filesystem::path session_with_displaced_tags(const std::filesystem::path& folder) {
  const auto session = folder / "displaced";
  std::filesystem::create_directory(session);
  for (const char* name : {"session.json", "camera.yaml", "object.ply", "frames.avi"}) {
    std::filesystem::copy(sample_session() / name, session / name);
  }
  capture::Board board = capture::read_board(sample_session() / "board.yaml");
  std::mt19937 random(9);
  std::normal_distribution<double> shift_m(0, 0.0005);
  for (auto& [id, tag] : board.tags) {
    tag.board_from_tag.translation() += Eigen::Vector3d(shift_m(random), shift_m(random), 0);
  }
  capture::write_board(session / "board.yaml", board);
  return session;
}

/// Root mean square over frames of how far the camera is from its true place, after the one rigid
/// motion of the board that fits all frames best: displaced tags leave the board frame itself open.
double relative_error_m(const std::filesystem::path& estimate) {
  const auto truth = capture::read_trajectory(sample_session() / "truth_poses.txt");
  const auto found = capture::read_trajectory(estimate);
  Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(found.entries().size()));
  Eigen::Matrix3Xd to(3, from.cols());
  Eigen::Index column = 0;
  for (const auto& entry : found.entries()) {
    for (const auto& reference : truth.entries()) {
      if (reference.stamp != entry.stamp) continue;
      from.col(column) = entry.board_from_camera.translation();
      to.col(column++) = reference.board_from_camera.translation();
    }
  }
  from.conservativeResize(3, column);
  to.conservativeResize(3, column);
  const Eigen::Isometry3d motion(Eigen::umeyama(from, to, false));
  return std::sqrt(((motion * from) - to).squaredNorm() / static_cast<double>(column));
}

nlohmann::json replay(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "replay");
  arguments.insert(arguments.end(), {"--end", "60", "--json", "--quiet"});
  const ProgramRun run = run_sheen(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.standard_error;
  return run.exit_code == 0 ? run.json() : nlohmann::json();
}

TEST(RefineBoard, HalvesThePoseErrorOfDisplacedTags) {
  const TemporaryFolder folder;
  const auto session = session_with_displaced_tags(folder.path());
  const auto model = folder.path() / "model.glb";
  const auto before = folder.path() / "before.txt";
  const auto after = folder.path() / "after.txt";
  replay({session, "-o", model, "--poses-out", before});
  const auto report = replay({session, "-o", model, "--poses-out", after, "--refine-board"});
  ASSERT_FALSE(report["board_refinement"].is_null());
  EXPECT_LT(report["board_refinement"]["rms_after_px"].get<double>(),
            0.5 * report["board_refinement"]["rms_before_px"].get<double>());
  EXPECT_LT(relative_error_m(after), 0.5 * relative_error_m(before));
}

TEST(RefinePoses, LeavesGoodTagPosesGood) {
  // The guard's promise: poses that are right to 0.03 px may not be moved by more than what is
  // expected of their error, 0.3 px, which is 0.5 mm at this distance and focal length.
  const TemporaryFolder folder;
  const auto poses = folder.path() / "poses.txt";
  const auto report = replay({sample_session(), "-o", folder.path() / "model.glb", "--poses-out",
                              poses, "--refine-poses", "--hold-out", "10"});
  EXPECT_LT(report["pose_refinement"]["motion_px"].get<double>(), 0.3);
  EXPECT_FALSE(report["held_out_refined_poses"].is_null());
}

/// The sample session with given poses, every one turned about the camera's axes by normal angles
/// of 0.08 degrees, which is about a pixel.
std::filesystem::path session_with_noisy_poses(const std::filesystem::path& folder) {
  const auto session = folder / "noisy";
  std::filesystem::create_directory(session);
  for (const char* name : {"camera.yaml", "object.ply", "frames.avi"}) {
    std::filesystem::copy(sample_session() / name, session / name);
  }
  auto json = nlohmann::json::parse(read_file(sample_session() / "session.json"));
  json.erase("board");
  json["poses"] = "poses.txt";
  write_file(session / "session.json", json.dump());

  std::mt19937 random(4);
  std::normal_distribution<double> angle_rad(0, 0.08 * std::numbers::pi / 180);
  std::ofstream poses(session / "poses.txt");
  poses.precision(12);
  const auto truth = capture::read_trajectory(sample_session() / "truth_poses.txt");
  for (const auto& [stamp, board_from_camera] : truth.entries()) {
    const Eigen::Vector3d turn(angle_rad(random), angle_rad(random), angle_rad(random));
    const Eigen::Vector3d t = board_from_camera.translation();
    const Eigen::Quaterniond q(board_from_camera.linear() *
                               Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    poses << stamp << ' ' << t.transpose() << ' ' << q.coeffs().transpose() << '\n';
  }
  return session;
}

// Views at refined poses are nearer to the model than at the given ones: measured 31.5 against 29.4
// dB.
TEST(RefinePoses, BringsNoisyPosesNearer) {
  const TemporaryFolder folder;
  const auto report =
      replay({session_with_noisy_poses(folder.path()), "-o", folder.path() / "model.glb",
              "--refine-poses", "--pose-error", "1", "--hold-out", "10"});
  EXPECT_GT(report["held_out_refined_poses"]["psnr"].get<double>(),
            report["held_out"]["psnr"].get<double>() + 1.05);  // half of it
}

TEST(Exposure, IsFoundNearOneForASteadyCamera) {
  const TemporaryFolder folder;
  const auto report = replay({sample_session(), "-o", folder.path() / "model.glb", "--exposure"});
  EXPECT_GT(report["exposure"]["frames"].get<int>(), 0);
  EXPECT_NEAR(report["exposure"]["median"].get<double>(), 1.0, 0.02);
}

// The sample's mesh is that of its pictures: heights are tried, since it is much coarser than its
// texels, and nothing confirms them. What is kept is kept to the last bit.
TEST(RefineMesh, IsTriedByDefaultAndKeepsAGoodMesh) {
  const TemporaryFolder folder;
  const auto as_is = folder.path() / "as_is.glb", tried = folder.path() / "tried.glb";
  const auto mesh = folder.path() / "mesh.ply";
  const auto unasked = replay({sample_session(), "-o", tried, "--write-mesh", mesh});
  ASSERT_FALSE(unasked["mesh_refinement"].is_null());
  EXPECT_FALSE(unasked["mesh_refinement"]["accepted"].get<bool>());
  EXPECT_TRUE(std::filesystem::exists(mesh));
  EXPECT_TRUE(
      replay({sample_session(), "-o", as_is, "--no-refine-mesh"})["mesh_refinement"].is_null());
  EXPECT_EQ(read_file(as_is), read_file(tried));
  // Patches at vertices alone see no print between them.
  EXPECT_TRUE(
      replay({sample_session(), "-o", as_is, "--patches", "vertex"})["mesh_refinement"].is_null());
}

// The real box bulges where its mesh is flat: 23.94 dB on the mesh as it is, 26.45 refined; half of
// that gain is asked for.
TEST(RefineMesh, MendsTheRealBoxByDefault) {
  const auto session = shared_session("box");
  if (session.empty()) GTEST_SKIP() << "the recording is not there";
  const TemporaryFolder folder;
  const ProgramRun run = run_sheen(
      {"replay", session, "-o", folder.path() / "box.glb", "--hold-out", "5", "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_TRUE(run.json()["mesh_refinement"]["accepted"].get<bool>());
  EXPECT_GT(run.json()["held_out"]["psnr"].get<double>(), 25.2);
}

// The session puts the object 1 mm beside its place. Held-out frames: 33.3 dB there, 35.5 put
// right; half of that gain is asked for.
class RefineMeshAside : public CopiedSession {
 protected:
  RefineMeshAside() {
    auto session = nlohmann::json::parse(read_file(session_ / "session.json"));
    auto& x_m = session["object"]["T_stage_object"][3];
    x_m = x_m.get<double>() + 0.001;
    write_file(session_ / "session.json", session.dump());
  }
};

TEST_F(RefineMeshAside, IsPutRightAndSaid) {
  const auto fit = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command{"replay", session_, "-o", model_, "--hold-out", "5", "--json"};
    command.insert(command.end(), more.begin(), more.end());
    return run_sheen(command);
  };
  const ProgramRun left = fit({"--no-refine-mesh"}), placed = fit({});
  ASSERT_EQ(left.exit_code, 0) << left.standard_error;
  ASSERT_EQ(placed.exit_code, 0) << placed.standard_error;
  EXPECT_TRUE(left.json()["mesh_placement"].is_null());
  EXPECT_TRUE(left.json()["findings"].empty());
  const auto said = placed.json();
  // The mesh's frame is turned against the board's; the way is as long. 1.02 mm are measured.
  double shift2_mm2 = 0;
  for (const double mm : said["mesh_placement"]["shift_mm"]) shift2_mm2 += mm * mm;
  EXPECT_NEAR(std::sqrt(shift2_mm2), 1, 0.15);
  ASSERT_EQ(said["findings"].size(), 1u);
  EXPECT_EQ(said["findings"][0]["cause"], "mesh-place");
  EXPECT_NE(placed.standard_error.find("mm beside its mesh"), std::string::npos);
  EXPECT_GT(said["held_out"]["psnr"].get<double>(),
            left.json()["held_out"]["psnr"].get<double>() + 1);
}

// While it is recorded the mesh is fitted already: only said, at the end.
TEST_F(RefineMeshAside, IsSaidOfACapture) {
  for (const bool is_live : {true, false}) {
    pipeline::ProgressSink sink;
    pipeline::Reconstruction fitted(
        {.session = capture::open_session(session_), .is_live = is_live}, {.frames = {.end = 60}},
        sink);
    fitted.run(sink);
    EXPECT_EQ(fitted.mesh_placement().has_value(), !is_live);
    ASSERT_EQ(fitted.findings().size(), 1u);
    EXPECT_EQ(fitted.findings()[0].cause, "mesh-place");
    const std::string& line = fitted.findings()[0].line;
    EXPECT_EQ(line.find("sheen replay of this session") != std::string::npos, is_live) << line;
  }
}

TEST(RefineMesh, WordsThatContradictEachOtherAreRefused) {
  const TemporaryFolder folder;
  const std::string model = folder.path() / "model.glb";
  const std::vector<std::vector<std::string>> contradictions{
      {"--refine-mesh", "--no-refine-mesh"},
      {"--no-refine-mesh", "--write-mesh", folder.path() / "mesh.ply"},
      {"--refine-mesh", "--state", folder.path() / "a.state"}};
  for (const auto& words : contradictions) {
    std::vector<std::string> command{"replay", sample_session(), "-o", model};
    command.insert(command.end(), words.begin(), words.end());
    const ProgramRun run = run_sheen(command);
    EXPECT_EQ(run.exit_code, 2) << words.front() << " " << words[1];
    EXPECT_NE(run.standard_error.find("refine-mesh"), std::string::npos) << run.standard_error;
    EXPECT_FALSE(std::filesystem::exists(model));
  }
}

}  // namespace
}  // namespace sheen::tests
