// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_source.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

namespace sheen::bench {

/// When a camera's frames come, and how many found no room in its queue.
class CameraPace {
 public:
  /// `fps` > 0.
  explicit CameraPace(double fps) : period_(1 / fps) {}

  /// Waits until the frame after the last one has come. False when that was so long ago that a
  /// camera would have thrown it away.
  bool wait_for_next();
  [[nodiscard]] int dropped() const { return dropped_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::chrono::duration<double> period_;
  Clock::time_point begin_{};
  int frames_ = 0;
  std::atomic<int> dropped_{0};
};

/// A recording as a camera at this pace would give it. `pace` outlives it.
class PacedSource final : public capture::FrameSource {
 public:
  PacedSource(std::unique_ptr<capture::FrameSource> recording, CameraPace& pace)
      : recording_(std::move(recording)), pace_(pace) {}

  std::optional<capture::Frame> next() override;
  [[nodiscard]] std::optional<int> frame_count() const override { return std::nullopt; }

 private:
  std::unique_ptr<capture::FrameSource> recording_;
  CameraPace& pace_;
};

}  // namespace sheen::bench
