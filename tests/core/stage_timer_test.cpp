// SPDX-License-Identifier: MIT
#include "core/diagnostics/stage_timer.h"

#include <gtest/gtest.h>
#include <time.h>

#include <numeric>

namespace sheen::core {
namespace {

double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

void burn(double ms) {
  const double end = cpu_ms() + ms;
  while (cpu_ms() < end) {
  }
}

TEST(Summarise, HasClosedForms) {
  EXPECT_EQ(summarise({}).mean, 0);
  const StageSummary four = summarise({4, 1, 3, 2});
  EXPECT_EQ(four.mean, 2.5);
  EXPECT_EQ(four.median, 2.5);
  EXPECT_EQ(four.p95, 4);
  std::vector<double> hundred(100);
  std::iota(hundred.begin(), hundred.end(), 1);
  EXPECT_EQ(summarise(hundred).p95, 95);
  EXPECT_EQ(summarise({7}).p95, 7);
  EXPECT_EQ(summarise({7}).median, 7);
}

TEST(StageTimer, MeasuresCpuPerFrame) {
  StageTimer timer;
  for (int frame = 0; frame < 3; ++frame) {
    const auto frame_scope = timer.measure_frame();
    for (int part = 0; part < 2; ++part) {
      const auto scope = timer.measure("fit");
      burn(2);
    }
    if (frame == 1) {
      const auto scope = timer.measure("rare");
      burn(1);
    }
  }
  // Two parts of at least 2 ms make one figure of at least 4 ms per frame.
  EXPECT_GE(timer.summary("fit").mean, 4);
  EXPECT_GE(timer.summary("fit").median, 4);
  // Once in three frames: the mean is over the frames in which it ran.
  EXPECT_GE(timer.summary("rare").mean, 1);
  EXPECT_EQ(timer.summary("rare").mean, timer.summary("rare").p95);
  EXPECT_EQ(timer.summary("never").mean, 0);
  // Stages run within frames, and one thread gets no more CPU than time passes (clocks apart by
  // less than 0.1 ms).
  EXPECT_GE(timer.frame_cpu().mean, timer.summary("fit").mean);
  EXPECT_GE(timer.frame_wall().mean + 0.1, timer.frame_cpu().mean);
}

TEST(StageTimer, DiscardedFramesLeaveNoTrace) {
  StageTimer timer;
  {
    auto frame = timer.measure_frame();
    const auto scope = timer.measure("decode");
    frame.discard();
  }
  { const auto frame = timer.measure_frame(); }
  // The stage scope above ends before its frame does, so nothing of it is left for the next one.
  EXPECT_EQ(timer.summary("decode").p95, 0);
  EXPECT_EQ(timer.frame_cpu().mean, timer.frame_cpu().p95);
}

}  // namespace
}  // namespace sheen::core
