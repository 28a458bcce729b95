// SPDX-License-Identifier: MIT
#include "capture/source/paced_source.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

namespace sheen::capture {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLate{100};         // made up for; what is more is let go
constexpr std::chrono::milliseconds kLongestWait{200};  // a gap in the recording is cut short

class PacedSource final : public FrameSource {
 public:
  explicit PacedSource(std::unique_ptr<FrameSource> recording) : recording_(std::move(recording)) {}

  std::optional<Frame> next() override {
    auto frame = recording_->next();
    if (frame) wait_until(frame->time_s);
    return frame;
  }

  [[nodiscard]] SourceReport report() const override { return recording_->report(); }

  [[nodiscard]] std::optional<int> frame_count() const override {
    return recording_->frame_count();
  }

 private:
  void wait_until(double time_s) {
    const auto since_begin =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
    const auto now = Clock::now();
    begin_ = std::clamp(begin_.value_or(now - since_begin), now - since_begin - kLate,
                        now - since_begin + kLongestWait);
    std::this_thread::sleep_until(*begin_ + since_begin);
  }

  std::unique_ptr<FrameSource> recording_;
  std::optional<Clock::time_point> begin_;  ///< when the recording's time was 0
};

}  // namespace

std::unique_ptr<FrameSource> at_recorded_pace(std::unique_ptr<FrameSource> recording) {
  return std::make_unique<PacedSource>(std::move(recording));
}

}  // namespace sheen::capture
