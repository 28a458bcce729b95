// SPDX-License-Identifier: MIT
// The whole way: recording -> tags -> pose -> visibility -> samples -> fit -> model -> views never
// seen.
#include "capture/pose/trajectory.h"
#include "core/visibility/raster_visibility.h"
#include "core/visibility/ray_visibility.h"
#include "pipeline/reconstruct.h"
#include "render/context/context.h"
#include "render/visibility/depth_visibility.h"
#include "tests/app/program.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <utility>

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

/// Three times the squared error, in decibels.
const double kThriceTheError_db = 10 * std::log10(3.0);

/// A fitter and by how much it was measured to beat the mean colours, dB.
struct MeasuredFitter {
  const char* name;
  double gain_db;
};

class SampleSession : public testing::TestWithParam<MeasuredFitter> {};

INSTANTIATE_TEST_SUITE_P(Fitters, SampleSession,
                         testing::Values(MeasuredFitter{"sparse", 11.4},
                                         MeasuredFitter{"quadtree", 9.5}),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_P(SampleSession, IsPosedFromItsTagsAndBeatsMeanColoursOnViewsNeverSeen) {
  const TemporaryFolder folder;
  const auto model = folder.path() / "model.glb";
  const auto mean = folder.path() / "mean.glb";
  const auto poses = folder.path() / "poses.txt";
  const ProgramRun replay =
      run_sheen({"replay", sample_session(), "-o", model, "--fitter", GetParam().name, "--mean-out",
                 mean, "--poses-out", poses, "--json", "--quiet"});
  ASSERT_EQ(replay.exit_code, 0) << replay.standard_error;
  const auto report = replay.json();

  // Poses: every frame; medians of 0.031 mm and 0.0039 degrees were measured.
  EXPECT_EQ(report["frames"]["read"], 120);
  EXPECT_EQ(report["frames"]["posed"], 120);
  const PoseErrors errors = compare_poses(poses, sample_session() / "truth_poses.txt");
  ASSERT_EQ(errors.degrees.size(), 120u);
  EXPECT_LT(median(errors.millimetres), 3 * 0.031);
  EXPECT_LT(median(errors.degrees), 3 * 0.0039);

  // Clean views beside the path, against what a textured mesh shows.
  const ProgramRun evaluation = run_sheen(
      {"evaluate", model, sample_session() / "held_out", "--beside", mean, "--json", "--quiet"});
  ASSERT_EQ(evaluation.exit_code, 0) << evaluation.standard_error;
  const auto figures = evaluation.json();
  EXPECT_GE(psnr(figures["mean"]) - psnr(figures["beside"]["mean"]),
            GetParam().gain_db - kThriceTheError_db);
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

/// Direction and colour of a sample, by frame and patch.
using Samples = std::map<std::pair<std::size_t, std::uint32_t>, std::array<float, 5>>;

/// Samples of the first frames of the sample session when hidden vertices are found like this.
Samples samples_with(const pipeline::VisibilityFactory& make_visibility) {
  struct Collector final : pipeline::FrameListener {
    bool admit(const core::SampleBatch& batch) override {
      for (std::size_t i = 0; i < batch.size(); ++i) {
        samples[{frame, batch.patch[i]}] = {batch.u[i], batch.v[i], batch.r[i], batch.g[i],
                                            batch.b[i]};
      }
      ++frame;
      return true;
    }
    Samples samples;
    std::size_t frame = 0;
  } collector;
  pipeline::ProgressSink sink;
  pipeline::Reconstruction(
      {.session = capture::open_session(sample_session()), .make_visibility = make_visibility},
      {.representation = "mean", .frames = {.end = 8}}, sink)
      .run(sink, &collector);
  EXPECT_EQ(collector.frame, 8u);
  EXPECT_GT(collector.samples.size(), 10000u);
  return collector.samples;
}

/// Samples of `a` that `b` lacks; those of both must be the same in every bit.
double missing_from(const Samples& b, const Samples& a) {
  std::size_t missing = 0;
  std::size_t different = 0;
  for (const auto& [place, sample] : a) {
    const auto other = b.find(place);
    if (other == b.end()) {
      ++missing;
    } else if (other->second != sample) {
      ++different;
    }
  }
  EXPECT_EQ(different, 0u);
  return static_cast<double>(missing) / static_cast<double>(a.size());
}

// Where the z-buffer's word is in doubt it asks the rays, so that both say the same.
TEST(Replay, ZBufferIsTheDefaultAndGivesTheSamplesOfRays) {
  const auto z_buffer = [](const core::Mesh& mesh, int threads) {
    return core::make_raster_visibility(mesh, threads);
  };
  const Samples by_default = samples_with({});
  EXPECT_TRUE(by_default == samples_with(z_buffer));
  EXPECT_TRUE(by_default == samples_with(core::make_ray_visibility));
}

// OpenGL's depths are those of pixel centres: next to silhouettes a vertex may fall to either side.
// Against rays XX and YY of the samples were measured.
TEST(Replay, DepthsOfOpenGlGiveNearlyTheSamplesOfRays) {
  const auto gl = render::make_osmesa_context();
  const Samples depth = samples_with([&](const core::Mesh& mesh, int /*threads*/) {
    return render::make_depth_visibility(*gl, mesh);
  });
  const Samples rays = samples_with(core::make_ray_visibility);
  const double false_hidden = missing_from(depth, rays);
  const double false_visible = missing_from(rays, depth);
  std::cout << "hidden " << false_hidden << " visible " << false_visible << "\n";
  EXPECT_LT(false_hidden, 3 * 0.001);
  EXPECT_LT(false_visible, 3 * 0.01);
}

TEST(Replay, OptionsForVisibilityAreObeyed) {
  const TemporaryFolder folder;
  const auto model_with = [&](const std::string& visibility) {
    const auto model = folder / (visibility + ".glb");
    const ProgramRun run = run_sheen({"replay", sample_session(), "-o", model, "--end", "8",
                                      "--visibility", visibility, "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.standard_error;
    return read_file(model);
  };
  const std::string rays = model_with("rays");
  ASSERT_FALSE(rays.empty());
  EXPECT_TRUE(model_with("raster") == rays);
  EXPECT_TRUE(model_with("auto") == rays);
  EXPECT_FALSE(model_with("depth") == rays);  // other samples, another model
}

// Six frames are enough to explain half of what the mean colours of the same frames leave: from
// 3.9 dB (one term) to 6.6 (sparse) were measured, half is 3.
TEST(Replay, EveryConstructionLayoutAndBasisExplainsHalfOfWhatTheMeanLeaves) {
  const TemporaryFolder folder;
  const std::vector<std::vector<std::string>> choices{
      {"--fitter", "adaptive"},
      {"--fitter", "batch", "--layout", "disk"},
      {"--centers", "64", "--layout", "jittered-grid"},
      {"--terms", "1"},
      {"--terms", "6", "--layout", "jittered-disk"},
      {"--terms", "auto"},
      {"--faithful"},
      {"--representation", "sparse"},
      {"--representation", "sh"},
      {"--representation", "nearest-views"}};
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
    EXPECT_GT(psnr(run.json()["held_out"]) - psnr(run.json()["held_out_mean_colour"]),
              10 * std::log10(2.0))
        << choice.front() << " " << choice.back();
  }
}

TEST(Replay, MeanColoursAreTheirOwnBaseline) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_sheen({"replay", sample_session(), "-o", folder / "model.glb", "--start", "4", "--end",
                 "12", "--hold-out", "4", "--representation", "mean", "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_EQ(run.json()["held_out"], run.json()["held_out_mean_colour"]);
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
  expect_held_out_above_mean("box", 1.0);  // 2.1 were measured
}

TEST(RealRecordings, StoneIsPredictedBetterThanByMeanColours) {
  expect_held_out_above_mean("stone", 1.0);  // 2.3 were measured
}

}  // namespace
}  // namespace sheen::tests
