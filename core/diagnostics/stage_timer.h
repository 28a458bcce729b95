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

/// CPU time of the stages that one frame went through (`own_cpu_ms`). Travels with the frame from
/// thread to thread; one thread at a time.
class StageTimes {
 public:
  /// Runs until the end of its scope; a stage measured twice counts with the sum.
  class [[nodiscard]] Scope {
   public:
    Scope(StageTimes& times, std::string_view stage);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    Scope(Scope&&) = delete;
    Scope& operator=(Scope&&) = delete;

   private:
    StageTimes& times_;
    std::string stage_;
    double begin_cpu_ms_;
  };

  Scope measure(std::string_view stage) { return {*this, stage}; }

  /// Milliseconds by stage.
  [[nodiscard]] const std::map<std::string, double, std::less<>>& ms() const { return ms_; }

 private:
  std::map<std::string, double, std::less<>> ms_;
};

/// The times of all frames of a recording. One thread at a time.
class StageTimer {
 public:
  /// The first frame begins now.
  void start();

  /// A frame has gone through all its stages.
  void end_frame(const StageTimes& times);

  [[nodiscard]] StageSummary summary(std::string_view stage) const;

  /// CPU time of the process from the end of one frame to the end of the next.
  [[nodiscard]] StageSummary frame_cpu() const { return summarise(frame_cpu_ms_); }

  /// Wall time from the end of one frame to the end of the next: the inverse of the throughput,
  /// waiting for a slow reader included.
  [[nodiscard]] StageSummary frame_wall() const { return summarise(frame_wall_ms_); }

 private:
  using Clock = std::chrono::steady_clock;

  std::map<std::string, std::vector<double>, std::less<>> stage_ms_;
  std::vector<double> frame_cpu_ms_;
  std::vector<double> frame_wall_ms_;
  double last_end_cpu_ms_ = 0;
  Clock::time_point last_end_{};
};

}  // namespace sheen::core
