// SPDX-License-Identifier: MIT
#include "core/diagnostics/stage_timer.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sheen::core {
namespace {

double process_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace

StageSummary summarise(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t count = values.size();
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(count)));
  return {.mean = sum / static_cast<double>(count),
          .median = (values[(count - 1) / 2] + values[count / 2]) / 2,
          .p95 = values[rank - 1]};
}

StageTimer::StageScope::StageScope(StageTimer& timer, std::string_view stage)
    : timer_(timer), stage_(stage), begin_cpu_ms_(process_cpu_ms()) {}

StageTimer::StageScope::~StageScope() {
  timer_.open_ms_[stage_] += process_cpu_ms() - begin_cpu_ms_;
}

StageTimer::FrameScope::FrameScope(StageTimer& timer)
    : timer_(timer), begin_cpu_ms_(process_cpu_ms()) {
  if (timer_.frame_cpu_ms_.empty()) timer_.last_frame_end_ = Clock::now();
}

StageTimer::FrameScope::~FrameScope() {
  if (keep_) {
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double, std::milli> wall = now - timer_.last_frame_end_;
    timer_.last_frame_end_ = now;
    timer_.frame_wall_ms_.push_back(wall.count());
    timer_.frame_cpu_ms_.push_back(process_cpu_ms() - begin_cpu_ms_);
    for (const auto& [stage, ms] : timer_.open_ms_) timer_.closed_ms_[stage].push_back(ms);
  }
  timer_.open_ms_.clear();
}

StageSummary StageTimer::summary(std::string_view stage) const {
  const auto found = closed_ms_.find(stage);
  return found == closed_ms_.end() ? StageSummary{} : summarise(found->second);
}

}  // namespace sheen::core
