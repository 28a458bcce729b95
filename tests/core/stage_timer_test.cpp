// SPDX-License-Identifier: MIT
#include "core/diagnostics/stage_timer.h"

#include "core/concurrency/parallel_for.h"
#include "core/diagnostics/cpu_clock.h"

#include <gtest/gtest.h>

#include <numeric>
#include <thread>

namespace sheen::core {
namespace {

void burn(double ms) {
  const double end = own_cpu_ms() + ms;
  while (own_cpu_ms() < end) {
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
  timer.start();
  for (int frame = 0; frame < 3; ++frame) {
    StageTimes times;
    for (int part = 0; part < 2; ++part) {
      const auto scope = times.measure("fit");
      burn(2);
    }
    if (frame == 1) {
      const auto scope = times.measure("rare");
      burn(1);
    }
    timer.end_frame(times);
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

TEST(StageTimes, AnotherThreadsWorkCountsOnlyWhereItWasDoneForThisOne) {
  // What a thread beside this one does is not of this stage: the thread burns 20 ms, the stage
  // less.
  StageTimes alone;
  {
    const auto scope = alone.measure("wait");
    std::jthread other([] { burn(20); });
  }
  EXPECT_LT(alone.ms().at("wait"), 20);
  // Two parts of at least 5 ms of their own thread's time each are 10 ms of work, whoever does
  // them.
  StageTimes shared;
  {
    const auto scope = shared.measure("work");
    parallel_for(512, 2, [](std::size_t, std::size_t) {
      const double end = own_cpu_ms() + 5;
      while (own_cpu_ms() < end) {
      }
    });
  }
  EXPECT_GE(shared.ms().at("work"), 10);
}

}  // namespace
}  // namespace sheen::core
