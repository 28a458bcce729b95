// SPDX-License-Identifier: MIT
// The whole way: recording -> tags -> pose -> visibility -> samples -> fit -> model -> views never
// seen.
#include "capture/pose/trajectory.h"
#include "tests/app/program.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>

namespace sheen::tests {
namespace {

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// Camera-centre distance (mm) and rotation angle (degrees) per frame posed in both files.
struct PoseErrors {
  std::vector<double> millimetres;
  std::vector<double> degrees;
};

PoseErrors compare_poses(const std::filesystem::path& estimate,
                         const std::filesystem::path& truth) {
  PoseErrors errors;
  const capture::Trajectory estimated = capture::read_trajectory(estimate);
  const capture::Trajectory true_poses = capture::read_trajectory(truth);
  for (const auto& entry : estimated.entries()) {
    for (const auto& reference : true_poses.entries()) {
      if (reference.stamp != entry.stamp) continue;
      const Eigen::Isometry3d difference =
          reference.board_from_camera.inverse() * entry.board_from_camera;
      errors.millimetres.push_back(1000 * difference.translation().norm());
      errors.degrees.push_back(Eigen::AngleAxisd(difference.linear()).angle() * 180 / M_PI);
    }
  }
  return errors;
}

double psnr(const nlohmann::json& error) {
  return error.at("psnr").get<double>();
}

class SampleSession : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Fitters, SampleSession, testing::Values("sparse", "quadtree"));

TEST_P(SampleSession, IsPosedFromItsTagsAndBeatsMeanColoursOnViewsNeverSeen) {
  const TemporaryFolder folder;
  const auto model = folder.path() / "model.glb";
  const auto mean = folder.path() / "mean.glb";
  const auto poses = folder.path() / "poses.txt";
  const ProgramRun replay =
      run_sheen({"replay", sample_session(), "-o", model, "--fitter", GetParam(), "--mean-out",
                 mean, "--poses-out", poses, "--json", "--quiet"});
  ASSERT_EQ(replay.exit_code, 0) << replay.standard_error;
  const auto report = replay.json();

  // Poses: at least 95 % of the frames, median below 0.3 mm and 0.03 degrees.
  const double read = report["frames"]["read"];
  EXPECT_GE(report["frames"]["posed"].get<double>(), 0.95 * read);
  const PoseErrors errors = compare_poses(poses, sample_session() / "truth_poses.txt");
  ASSERT_GE(static_cast<double>(errors.degrees.size()), 0.95 * read);
  EXPECT_LT(median(errors.millimetres), 0.3);
  EXPECT_LT(median(errors.degrees), 0.03);

  // Clean views beside the path: at least 2 dB above what a textured mesh shows.
  const ProgramRun evaluation = run_sheen(
      {"evaluate", model, sample_session() / "held_out", "--beside", mean, "--json", "--quiet"});
  ASSERT_EQ(evaluation.exit_code, 0) << evaluation.standard_error;
  const auto figures = evaluation.json();
  EXPECT_GE(psnr(figures["mean"]), psnr(figures["beside"]["mean"]) + 2.0);
}

TEST(MatteScene, IsNotFittedWorseThanByMeanColours) {
  const TemporaryFolder folder;
  const auto session = folder.path() / "matte";
  const ProgramRun synth = run_sheen({"synth", "matte", "-o", session, "--size", "320x180",
                                      "--frames", "60", "--vertices", "4000", "--quiet"});
  ASSERT_EQ(synth.exit_code, 0) << synth.standard_error;
  const auto model = folder.path() / "model.glb";
  const auto mean = folder.path() / "mean.glb";
  const ProgramRun replay =
      run_sheen({"replay", session, "-o", model, "--mean-out", mean, "--quiet"});
  ASSERT_EQ(replay.exit_code, 0) << replay.standard_error;
  const ProgramRun evaluation =
      run_sheen({"evaluate", model, session / "held_out", "--beside", mean, "--json", "--quiet"});
  ASSERT_EQ(evaluation.exit_code, 0) << evaluation.standard_error;
  const auto figures = evaluation.json();
  EXPECT_GE(psnr(figures["mean"]), psnr(figures["beside"]["mean"]));
}

TEST(Replay, IsTheSameByteForByteForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const auto replay_with = [&](const std::string& threads) {
    const auto model = folder.path() / (threads + ".glb");
    const ProgramRun run = run_sheen(
        {"replay", sample_session(), "-o", model, "--end", "16", "--threads", threads, "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.standard_error;
    return read_file(model);
  };
  // One thread runs the producer on the caller's thread; more give it its own and split its work.
  const std::string sequential = replay_with("1");
  ASSERT_FALSE(sequential.empty());
  EXPECT_EQ(sequential, replay_with("2"));
  EXPECT_EQ(sequential, replay_with("5"));
}

TEST(Replay, BothVisibilitiesGiveNearlyTheSameSamples) {
  const TemporaryFolder folder;
  const auto samples_with = [&](const std::string& visibility) {
    const ProgramRun run =
        run_sheen({"replay", sample_session(), "-o", folder.path() / "model.glb", "--end", "8",
                   "--visibility", visibility, "--json", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.standard_error;
    return run.json()["samples"].get<double>();
  };
  const double rays = samples_with("rays");
  EXPECT_NEAR(samples_with("depth"), rays, 0.01 * rays);
}

TEST(Replay, EveryConstructionLayoutAndBasisGivesAFiniteModelThatCanBeDrawn) {
  const TemporaryFolder folder;
  const std::vector<std::vector<std::string>> choices{
      {"--fitter", "adaptive"},
      {"--fitter", "batch", "--layout", "disk"},
      {"--centers", "64", "--layout", "jittered-grid"},
      {"--terms", "1"},
      {"--terms", "6", "--layout", "jittered-disk"},
      {"--terms", "auto"},
      {"--faithful"},
      {"--representation", "mean"}};
  for (const auto& choice : choices) {
    std::vector<std::string> arguments{"replay",     sample_session(),
                                       "-o",         folder.path() / "model.glb",
                                       "--start",    "4",
                                       "--end",      "12",
                                       "--hold-out", "4",
                                       "--json",     "--quiet"};
    arguments.insert(arguments.end(), choice.begin(), choice.end());
    const ProgramRun run = run_sheen(arguments);
    ASSERT_EQ(run.exit_code, 0) << choice.front() << ": " << run.standard_error;
    // Frames 6 and 10 are held out of 4 .. 11: index % 4 == 2.
    EXPECT_EQ(run.json()["frames"]["held_out"], 2);
    EXPECT_EQ(run.json()["frames"]["fitted"], 6);
    EXPECT_GT(psnr(run.json()["held_out"]), 15.0) << choice.front();
  }
}

TEST(RealRecordings, DragonIsPosedFromItsTags) {
  const auto session = shared_session("visp_dragon");
  if (session.empty()) GTEST_SKIP() << "visp_dragon is not here";
  const TemporaryFolder folder;
  const auto poses = folder.path() / "poses.txt";
  const ProgramRun run = run_sheen({"replay", session, "-o", folder.path() / "model.glb",
                                    "--poses-out", poses, "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_LT(run.json()["reprojection_px"].get<double>(), 0.7);
  // Frames whose tags and silhouette agree, as the set's README lists them.
  const std::vector<int> good{0,  1,  2,  3,  4,  5,  6,  7,  8,  14, 27, 28, 29,
                              31, 32, 33, 35, 63, 64, 74, 76, 77, 93, 96, 98};
  int posed = 0;
  const capture::Trajectory estimated = capture::read_trajectory(poses);
  for (const auto& entry : estimated.entries()) {
    posed += static_cast<int>(std::count(good.begin(), good.end(), static_cast<int>(entry.stamp)));
  }
  EXPECT_GE(posed, 0.9 * static_cast<double>(good.size()));
}

void expect_held_out_above_mean(const std::string& name, double margin_db) {
  const auto session = shared_session(name);
  if (session.empty()) GTEST_SKIP() << name << " is not here";
  const TemporaryFolder folder;
  const ProgramRun run = run_sheen({"replay", session, "-o", folder.path() / "model.glb",
                                    "--hold-out", "5", "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_GE(psnr(run.json()["held_out"]), psnr(run.json()["held_out_mean_colour"]) + margin_db);
}

TEST(RealRecordings, BoxIsPredictedBetterThanByMeanColours) {
  expect_held_out_above_mean("box", 0.5);
}

TEST(RealRecordings, StoneIsPredictedNoWorseThanByMeanColours) {
  expect_held_out_above_mean("stone", 0.0);
}

}  // namespace
}  // namespace sheen::tests
