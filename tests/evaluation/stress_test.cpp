// SPDX-License-Identifier: MIT
#include "evaluation/stress/stress_study.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <algorithm>
#include <stdexcept>

namespace sheen::evaluation {
namespace {

constexpr StressOptions kTiny{
    .width_px = 160, .height_px = 120, .vertices = 500, .frames = 8, .held_out = 1, .samples = 1};

const StressKind& kind_of(const std::vector<StressKind>& kinds, const std::string& name) {
  return *std::ranges::find(kinds, name, &StressKind::name);
}

// A camera that rests sees the same whenever a row is taken, so neither a long exposure nor a
// rolling shutter changes anything but the last bits of sums.
TEST(StressKinds, ACameraThatRestsIsNeitherBlurredNorSheared) {
  StressRecording recording = render_stress_base(kTiny).recording;
  std::fill(recording.board_from_camera.begin(), recording.board_from_camera.end(),
            recording.board_from_camera.front());
  const auto kinds = stress_kinds();
  for (const char* name : {"motion-blur", "rolling-shutter"}) {
    StressRecording damaged = recording;
    kind_of(kinds, name).damage(damaged, 10);
    for (std::size_t i = 0; i < recording.light.size(); ++i) {
      EXPECT_LT(cv::norm(damaged.light[i], recording.light[i], cv::NORM_INF), 1e-5) << name;
    }
  }
}

// Of 8 frames the last 4 look at an object that was moved by 10 mm: their poses, and no others, are
// wrong by just that, and without a turn. The upper median of four 0 and four 10 is 10. At 0.4 m
// and 144 px of focal length 10 mm are 3.6 px, more than what counts as wrong.
TEST(Stress, PosesOfANudgedObjectAreWrongByTheNudge) {
  tests::TemporaryFolder folder;
  const auto rows = run_stress(kTiny, {"nudge"}, folder.path(), [](const std::string&) {});
  ASSERT_EQ(rows.size(), 4u);  // undamaged, then three severities
  EXPECT_EQ(rows[0].kind, "none");
  const StressRow& worst = rows.back();
  EXPECT_DOUBLE_EQ(worst.severity, 0.01);
  EXPECT_EQ(worst.posed, 8);
  EXPECT_EQ(worst.refused, 0);
  EXPECT_EQ(worst.wrongly_posed, 4);
  EXPECT_NEAR(worst.pose_error_mm, 10, 1e-4);
  EXPECT_NEAR(worst.pose_error_deg, 0, 1e-4);
}

TEST(Stress, AnUnknownKindIsNamed) {
  EXPECT_THROW(run_stress(kTiny, {"rain"}, ".", [](const std::string&) {}), std::invalid_argument);
}

TEST(Stress, WhatWasSaid) {
  StressRow row;
  row.frames = 10;
  row.refused = 2;  // a fifth, not more
  EXPECT_EQ(what_was_said(row), "nothing");
  row.refused = 3;
  EXPECT_EQ(what_was_said(row), "frames refused");
  row.notes = {"doubtful"};
  EXPECT_EQ(what_was_said(row), "noted");
  row.refusal = "no frame is posed";
  EXPECT_EQ(what_was_said(row), "refused");
}

}  // namespace
}  // namespace sheen::evaluation
