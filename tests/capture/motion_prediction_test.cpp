// SPDX-License-Identifier: MIT
#include "capture/pose/motion_prediction.h"

#include <gtest/gtest.h>

namespace sheen::capture::test {
namespace {

Frame frame_at(int index, double time_s) {
  return {cv::Mat(), time_s, index};
}

/// A hand that turns and walks.
const Eigen::Isometry3d kStep = Eigen::Translation3d(0.003, -0.001, 0.002) *
                                Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, 2, -1).normalized());
const Eigen::Isometry3d kStart =
    Eigen::Translation3d(0, 0.1, 0.5) * Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitX());

TEST(MotionPrediction, KnowsNothingAtFirst) {
  const MotionPrediction motion;
  EXPECT_FALSE(motion.predict(frame_at(0, 0)));
  EXPECT_FALSE(motion.last());
}

TEST(MotionPrediction, StandsStillAfterOnePose) {
  MotionPrediction motion;
  motion.note(frame_at(0, 0), kStart);
  EXPECT_TRUE(motion.predict(frame_at(1, 0.033))->isApprox(kStart, 1e-12));
}

TEST(MotionPrediction, RepeatsTheLastStep) {
  MotionPrediction motion;
  motion.note(frame_at(0, 0), kStart);
  motion.note(frame_at(1, 0.033), kStep * kStart);
  EXPECT_TRUE(motion.last()->isApprox(kStep * kStart, 1e-12));
  EXPECT_TRUE(motion.predict(frame_at(2, 0.066))->isApprox(kStep * kStep * kStart, 1e-12));
}

// A frame was lost: twice the time, twice the step. Without usable times, frames are counted.
TEST(MotionPrediction, StretchesTheStepOverLostFrames) {
  for (const double fps : {30.0, 0.0}) {
    const auto time_s = [&](int index) { return fps > 0 ? index / fps : 0; };
    MotionPrediction motion;
    motion.note(frame_at(0, time_s(0)), kStart);
    motion.note(frame_at(1, time_s(1)), kStep * kStart);
    const auto predicted = motion.predict(frame_at(3, time_s(3)));
    // Twice the rotation about the same axis; twice the translation, but for the turn in between
    // (0.02 rad of 3 mm) and of the lever.
    const Eigen::Isometry3d truth = kStep * kStep * kStep * kStart;
    EXPECT_LT(Eigen::AngleAxisd((predicted->inverse() * truth).linear()).angle(), 1e-9);
    EXPECT_LT((predicted->translation() - truth.translation()).norm(), 1e-4);
  }
}

// Two minutes at 30 frames a second in which every prediction comes true: rounding may not grow.
// Without orthonormal rotations it grows by 1 + sqrt(2) a frame and is lost within 45 frames.
TEST(MotionPrediction, StaysARotationForTwoMinutes) {
  MotionPrediction motion;
  motion.note(frame_at(0, 0), kStart);
  motion.note(frame_at(1, 1 / 30.0), kStep * kStart);
  for (int i = 2; i < 3600; ++i) {
    const Frame frame = frame_at(i, i / 30.0);
    motion.note(frame, motion.predict(frame).value());
  }
  const Eigen::Matrix3d R = motion.last()->linear();
  EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(R.determinant(), 1, 1e-12);
  // 3599 steps of 0.02 rad.
  Eigen::Matrix3d expected = kStart.linear();
  for (int i = 1; i < 3600; ++i) expected = kStep.linear() * expected;
  EXPECT_LT(Eigen::AngleAxisd(Eigen::Matrix3d(R.transpose() * expected)).angle(), 1e-6);
}

}  // namespace
}  // namespace sheen::capture::test
