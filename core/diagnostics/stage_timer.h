// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::core {

/// Over the frames in which a stage ran, milliseconds; zeros when it never did.
struct StageSummary {
  double mean = 0;
  double median = 0;  ///< of an even number: mean of the two in the middle
  double p95 = 0;     ///< smallest value that at least 95 % do not exceed
};

StageSummary summarise(std::vector<double> values);

/// CPU time of named stages, frame by frame: the time of the whole process, worker threads
/// included (CLOCK_PROCESS_CPUTIME_ID). Stages of one frame run one after the other, on one thread;
/// a stage measured twice in a frame counts once with the sum.
class StageTimer {
 public:
  /// Runs until the end of its scope.
  class [[nodiscard]] StageScope {
   public:
    StageScope(StageTimer& timer, std::string_view stage);
    ~StageScope();
    StageScope(const StageScope&) = delete;
    StageScope& operator=(const StageScope&) = delete;
    StageScope(StageScope&&) = delete;
    StageScope& operator=(StageScope&&) = delete;

   private:
    StageTimer& timer_;
    std::string stage_;
    double begin_cpu_ms_;
  };

  /// Runs until the end of its scope and closes the frame there.
  class [[nodiscard]] FrameScope {
   public:
    explicit FrameScope(StageTimer& timer);
    ~FrameScope();
    FrameScope(const FrameScope&) = delete;
    FrameScope& operator=(const FrameScope&) = delete;
    FrameScope(FrameScope&&) = delete;
    FrameScope& operator=(FrameScope&&) = delete;

    /// There was no frame after all (end of the recording): nothing measured in it is kept.
    void discard() { keep_ = false; }

   private:
    StageTimer& timer_;
    double begin_cpu_ms_;
    bool keep_ = true;
  };

  StageScope measure(std::string_view stage) { return StageScope(*this, stage); }
  FrameScope measure_frame() { return FrameScope(*this); }

  [[nodiscard]] StageSummary summary(std::string_view stage) const;

  /// CPU time of the process within the frames.
  [[nodiscard]] StageSummary frame_cpu() const { return summarise(frame_cpu_ms_); }

  /// Wall time from the end of one frame to the end of the next, the first from its own beginning:
  /// the inverse of the throughput, waiting for a slow reader included.
  [[nodiscard]] StageSummary frame_wall() const { return summarise(frame_wall_ms_); }

 private:
  using Clock = std::chrono::steady_clock;

  std::map<std::string, double, std::less<>> open_ms_;  ///< stages of the frame under way
  std::map<std::string, std::vector<double>, std::less<>> closed_ms_;
  std::vector<double> frame_cpu_ms_;
  std::vector<double> frame_wall_ms_;
  Clock::time_point last_frame_end_{};
};

}  // namespace sheen::core
