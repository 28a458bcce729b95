// SPDX-License-Identifier: MIT
// Exposure and white balance by the paper around the tags.
#include "capture/calibration/camera_file.h"
#include "capture/pose/paper_light.h"
#include "capture/pose/trajectory.h"
#include "capture/synthetic/synthetic_session.h"
#include "core/image/srgb_curve.h"
#include "core/image/write_image.h"
#include "core/mesh/read_mesh.h"
#include "pipeline/light/light_leveller.h"
#include "pipeline/light/recording_light.h"
#include "pipeline/light/session_light.h"
#include "pipeline/pose_frames.h"
#include "pipeline/posed_views.h"
#include "tests/capture/rendered_board.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <numbers>

namespace sheen::pipeline {
namespace {

using capture::PaperLight;
using capture::PaperReader;
using capture::test::look_at_board;

/// The image under another exposure and white balance, RGB; light as sRGB has it.
cv::Mat exposed(const cv::Mat& image, const Eigen::Vector3d& gain) {
  cv::Mat changed = image.clone();
  for (auto pixel = changed.begin<cv::Vec3b>(); pixel != changed.end<cv::Vec3b>(); ++pixel) {
    for (int channel = 0; channel < 3; ++channel) {
      const float light = core::linear_from_srgb(static_cast<float>((*pixel)[channel]) / 255) *
                          static_cast<float>(gain[2 - channel]);
      (*pixel)[channel] = cv::saturate_cast<std::uint8_t>(255 * core::srgb_from_linear(light));
    }
  }
  return changed;
}

class LitBoard : public testing::Test {
 protected:
  capture::Board board_ = capture::test::make_grid_board("tag36h11", 5, 4, 0.045, 0.058);
  core::CameraModel camera_ = capture::test::make_camera(640, 360, true);
  Eigen::Isometry3d pose_ = look_at_board(0.45, 1.0, 0.4);
  cv::Mat image_ = capture::test::render_board(board_, camera_, pose_, {.light = 200});
  PaperReader paper_{board_, camera_};
};

// Paper of code 200 is light ((200 / 255 + .055) / 1.055)^2.4 = .578.
TEST_F(LitBoard, PaperIsReadAroundEveryTagThatIsSeen) {
  const auto lights = paper_.read(image_, pose_);
  EXPECT_GE(lights.size(), 12u);
  for (const PaperLight& light : lights) {
    for (Eigen::Index c = 0; c < 3; ++c) EXPECT_NEAR(light.rgb[c], 0.578, 0.006) << light.tag_id;
  }
}

// A hand before one tag, a finger beside another: the first is not read, the second's median is
// that of the other three sides.
TEST_F(LitBoard, WhatHidesPaperIsNotTakenForIt) {
  const auto corners = capture::test::true_corners(board_, camera_, pose_);
  const auto before = paper_.read(image_, pose_);
  ASSERT_GE(before.size(), 2u);
  const int hidden = before[0].tag_id, beside = before[1].tag_id;
  const auto at = [&](int tag, std::size_t corner) {
    const Eigen::Vector2d& px = corners.at(tag)[corner];
    return cv::Point2d(px.x(), px.y());
  };
  cv::Mat covered = image_.clone();
  cv::rectangle(covered, at(hidden, 3), at(hidden, 1), cv::Scalar(120, 140, 190), cv::FILLED);
  cv::line(covered, at(beside, 0), at(beside, 1), cv::Scalar(120, 140, 190), 3);
  for (const PaperLight& light : paper_.read(covered, pose_)) {
    EXPECT_NE(light.tag_id, hidden);
    EXPECT_NEAR(light.rgb.y(), 0.578, 0.006) << light.tag_id;
  }
}

// Light per tag times gain per frame. Each frame shows five tags of ten, one of them in a shadow
// that halves it: least absolute differences pass by what a minority says, so gains come back to a
// hundredth of a stop, but for the factor that no data can tell, which makes their median 1.
TEST(RecordingLight, GainsComeBack) {
  constexpr int frames = 12;
  const auto gain_of_frame = [](int f) {
    return Eigen::Vector3d(std::exp2(0.1 * (f - 5)), std::exp2(0.05 * (f - 5)), 1);
  };
  std::vector<std::vector<PaperLight>> seen(frames);
  for (int f = 0; f < frames; ++f) {
    for (int k = 0; k < 5; ++k) {
      const int tag = (f + k) % 10;
      const Eigen::Vector3d paper = Eigen::Vector3d(0.5, 0.45, 0.4) / (1 + 0.05 * tag);
      const double shade = k == f % 5 ? 0.5 : 1;
      seen[static_cast<std::size_t>(f)].push_back(
          {tag, shade * paper.cwiseProduct(gain_of_frame(f))});
    }
  }
  const auto light = solve_light(seen);
  ASSERT_TRUE(light);
  const Eigen::Vector3d first = *gain_of(seen[0], light->usual);
  for (int f = 0; f < frames; ++f) {
    const Eigen::Vector3d gain = *gain_of(seen[static_cast<std::size_t>(f)], light->usual);
    const Eigen::Vector3d expected = gain_of_frame(f).cwiseQuotient(gain_of_frame(0));
    EXPECT_LT((gain.cwiseQuotient(first) - expected).norm(), 0.02) << f;
  }
  // Eleven steps of .1 stops in red, .05 in green and none in blue.
  EXPECT_NEAR(light->change.most_stops, 1.1, 0.02);
  EXPECT_NEAR(light->change.exposure_stops, 1.65 / 3, 0.02);
  EXPECT_NEAR(light->change.balance_stops, 1.1, 0.02);
  EXPECT_TRUE(clearly_changes(*light));
  // Half way between the two in the middle of twelve: half a step.
  EXPECT_NEAR(gain_of(seen[6], light->usual)->x(), std::exp2(0.05), 5e-3);
}

// Paper that is overexposed in half of the frames: the tags that are not tell the gain, and where
// all are, it is at least what the darkest of them would take to be: 1 / .5.
TEST(RecordingLight, SaturatedPaperTellsNothingButALeastGain) {
  const auto frame = [](double gain) {
    std::vector<PaperLight> lights;
    for (const auto& [tag, paper] : {std::pair{1, 0.8}, {2, 0.75}, {3, 0.8}, {4, 0.5}, {5, 0.5}}) {
      lights.push_back({tag, Eigen::Vector3d::Constant(std::min(1.0, gain * paper))});
    }
    return lights;
  };
  std::vector<std::vector<PaperLight>> seen(7, frame(1));
  seen.resize(12, frame(1.5));
  const auto light = solve_light(seen);
  ASSERT_TRUE(light);
  EXPECT_NEAR(light->change.most_stops, std::log2(1.5), 1e-3);
  EXPECT_NEAR(gain_of(frame(1.5), light->usual)->x(), 1.5, 1e-3);
  EXPECT_NEAR(gain_of(frame(3), light->usual)->x(), 2, 1e-2);
}

// Two halves of a walk without a tag in common, each with tags of other paper: that is no change.
TEST(RecordingLight, FramesThatShareNoTagAreNotCompared) {
  std::vector<std::vector<PaperLight>> seen;
  for (int f = 0; f < 6; ++f) {
    seen.push_back({{1, Eigen::Vector3d::Constant(0.6)}, {2, Eigen::Vector3d::Constant(0.5)}});
  }
  for (int f = 0; f < 4; ++f) {
    seen.push_back({{3, Eigen::Vector3d::Constant(0.3)},
                    {4, Eigen::Vector3d::Constant(0.2)},
                    {5, Eigen::Vector3d::Constant(0.1)}});
  }
  EXPECT_NEAR(solve_light(seen)->change.most_stops, 0, 1e-3);
}

TEST(RecordingLight, LittleIsNoChangeAndFewFramesTellNothing) {
  std::vector<std::vector<PaperLight>> seen;
  for (int f = 0; f < 12; ++f) {
    const Eigen::Vector3d light = Eigen::Vector3d::Constant(0.4 * std::exp2(0.02 * f));
    seen.push_back({{1, light}, {2, light}, {3, light}});
  }
  EXPECT_FALSE(clearly_changes(*solve_light(seen)));  // .22 stops
  seen.resize(5);
  EXPECT_FALSE(solve_light(seen));
  seen.assign(12, {{1, Eigen::Vector3d::Constant(0.4)}});  // a single tag may be shaded
  EXPECT_FALSE(solve_light(seen));
}

// Levelling undoes an exposure but for what codes of 8 bits lose: half a code before and after,
// and the slope of the curves between at most 2 where light is halved.
TEST_F(LitBoard, LevellingUndoesAnExposure) {
  const tests::TemporaryFolder folder;
  capture::write_board(folder / "board.yaml", board_);
  capture::Session session;
  session.camera = camera_;
  session.board = folder / "board.yaml";
  EXPECT_EQ(LightLeveller(session).level(image_, pose_).data, image_.data);  // nothing to level

  for (const PaperLight& light : paper_.read(image_, pose_)) {
    session.paper_light[light.tag_id] = light.rgb;
  }
  const LightLeveller leveller(session);
  for (const Eigen::Vector3d& gain :
       {Eigen::Vector3d(0.5, 0.5, 0.5), Eigen::Vector3d(1.3, 1.0, 0.7)}) {
    const cv::Mat levelled = leveller.level(exposed(image_, gain), pose_);
    EXPECT_LE(cv::norm(levelled, image_, cv::NORM_INF), 3);
  }
  const Eigen::Isometry3d elsewhere = pose_ * Eigen::Translation3d(0.02, 0.03, 0);
  EXPECT_EQ(leveller.level(image_, elsewhere).data, image_.data);  // no tag is where it should be
}

/// A recording whose frames are exposed by a wave, as pictures.
class WavingLight : public testing::Test {
 protected:
  static constexpr int kFrames = 24;

  static Eigen::Vector3d gain(int frame, double stops) {
    const double wave = stops * std::sin(2 * std::numbers::pi * frame / kFrames);
    return Eigen::Vector3d::Constant(std::exp2(wave));
  }
  capture::Session recorded(double stops) const {
    capture::synthetic::SyntheticOptions options;
    options.vertices = 1000;
    options.width_px = 480;
    options.height_px = 270;
    options.frames = kFrames;
    options.held_out = 0;
    options.samples = 1;
    options.threads = 2;
    const auto folder = folder_ / fmt::format("{}", stops);
    capture::synthetic::write_synthetic_session(folder, options, {});
    const capture::Session session = capture::open_session(folder);
    const auto frames = capture::open_frames(session);
    std::filesystem::create_directories(folder / "images");
    while (const auto frame = frames->next()) {
      core::write_image(folder / fmt::format("images/{:04d}.png", frame->index),
                        exposed(frame->image, gain(frame->index, stops)));
    }
    auto document = nlohmann::json::parse(tests::read_file(folder / "session.json"));
    document["frames"] = {{"images", "images/%04d.png"}};
    tests::write_file(folder / "session.json", document.dump());
    return capture::open_session(folder);
  }
  tests::TemporaryFolder folder_;
};

struct Notes : ProgressSink {
  void note(const std::string& line) override { lines.push_back(line); }
  std::vector<std::string> lines;
};

// Whoever reads the recording again gets frames of one exposure: paper everywhere as in the frame
// whose gain is the usual one. Images differ by the codes' steps and the noise of 2 levels.
TEST_F(WavingLight, IsFoundAndLevelledWhereverFramesAreReadAgain) {
  capture::Session session = recorded(0.25);  // paper of light .81 is not saturated by 1.19
  Notes notes;
  complete_light(session, {}, notes);
  ASSERT_EQ(notes.lines.size(), 1u);
  EXPECT_NE(notes.lines[0].find("the exposure changes by 0.5 stops"), std::string::npos)
      << notes.lines[0];
  const auto views = pose_frames(session, {}, notes);
  ASSERT_GE(views.size(), 20u);
  const PaperReader paper(capture::read_board(*session.board), session.camera);
  for_each_view(session, nullptr, views,
                [&](const capture::Frame& frame, const Eigen::Isometry3d& camera_from_object) {
                  const auto seen = paper.read(
                      frame.image, camera_from_object * session.board_from_object.inverse());
                  const auto left = gain_of(seen, session.paper_light);
                  ASSERT_TRUE(left);
                  EXPECT_LT((*left - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff(), 0.03)
                      << frame.index;
                });
}

TEST_F(WavingLight, ASteadyLightIsLeftAlone) {
  capture::Session session = recorded(0);
  Notes notes;
  complete_light(session, {}, notes);
  EXPECT_TRUE(session.paper_light.empty());
  EXPECT_TRUE(notes.lines.empty());
}

}  // namespace
}  // namespace sheen::pipeline
