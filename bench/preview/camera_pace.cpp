// SPDX-License-Identifier: MIT
#include "bench/preview/camera_pace.h"

#include <thread>

namespace sheen::bench {
namespace {

constexpr int kQueuedFrames = 8;  // as many as capture/source/v4l2_stream asks the driver for

}  // namespace

bool CameraPace::wait_for_next() {
  if (frames_ == 0) begin_ = Clock::now();
  const auto due = begin_ + std::chrono::duration_cast<Clock::duration>(frames_ * period_);
  ++frames_;
  std::this_thread::sleep_until(due);
  const bool in_time = Clock::now() - due < kQueuedFrames * period_;
  dropped_ += in_time ? 0 : 1;
  return in_time;
}

std::optional<capture::Frame> PacedSource::next() {
  for (;;) {
    const bool in_time = pace_.wait_for_next();
    auto frame = recording_->next();
    if (!frame || in_time) return frame;
  }
}

}  // namespace sheen::bench
