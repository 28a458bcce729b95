// SPDX-License-Identifier: MIT
#include "capture/source/paced_source.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace sheen::capture {
namespace {

using Clock = std::chrono::steady_clock;

/// Frames without images, taken at these times.
class StampedFrames final : public FrameSource {
 public:
  explicit StampedFrames(std::vector<double> times_s) : times_s_(std::move(times_s)) {}
  std::optional<Frame> next() override {
    if (next_ == times_s_.size()) return std::nullopt;
    Frame frame;
    frame.time_s = times_s_[next_];
    frame.index = static_cast<int>(next_++);
    return frame;
  }
  [[nodiscard]] std::optional<int> frame_count() const override {
    return static_cast<int>(times_s_.size());
  }

 private:
  std::vector<double> times_s_;
  std::size_t next_ = 0;
};

TEST(PacedSource, GivesEveryFrameInOrder) {
  const auto source =
      at_recorded_pace(std::make_unique<StampedFrames>(std::vector{0.0, 0.01, 0.02}));
  EXPECT_EQ(source->frame_count(), 3);
  for (int i = 0; i < 3; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_EQ(frame->time_s, 0.01 * i);
  }
  EXPECT_FALSE(source->next());
}

TEST(PacedSource, IsNeverSoonerThanTheRecording) {
  // A recording that begins in its seventh second, as a part of a longer one does.
  const auto source =
      at_recorded_pace(std::make_unique<StampedFrames>(std::vector{7.0, 7.03, 7.06}));
  const auto before_first = Clock::now();
  for (int i = 0; i < 3; ++i) source->next();
  EXPECT_GE(Clock::now() - before_first, std::chrono::milliseconds(60));
}

TEST(PacedSource, CutsGapsShort) {
  // An hour without an image: were it kept, this test would not end.
  const auto source =
      at_recorded_pace(std::make_unique<StampedFrames>(std::vector{0.0, 3600.0, 3600.01}));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(source->next());
}

}  // namespace
}  // namespace sheen::capture
