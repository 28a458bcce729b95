// SPDX-License-Identifier: MIT
#include "core/diagnostics/stage_timer.h"

#include "core/diagnostics/cpu_clock.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sheen::core {

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

StageTimes::Scope::Scope(StageTimes& times, std::string_view stage)
    : times_(times), stage_(stage), begin_cpu_ms_(own_cpu_ms()) {}

StageTimes::Scope::~Scope() {
  times_.ms_[stage_] += own_cpu_ms() - begin_cpu_ms_;
}

void StageTimer::start() {
  last_end_cpu_ms_ = process_cpu_ms();
  last_end_ = Clock::now();
}

void StageTimer::end_frame(const StageTimes& times) {
  for (const auto& [stage, ms] : times.ms()) stage_ms_[stage].push_back(ms);
  const double now_cpu_ms = process_cpu_ms();
  frame_cpu_ms_.push_back(now_cpu_ms - last_end_cpu_ms_);
  last_end_cpu_ms_ = now_cpu_ms;
  const Clock::time_point now = Clock::now();
  frame_wall_ms_.push_back(std::chrono::duration<double, std::milli>(now - last_end_).count());
  last_end_ = now;
}

StageSummary StageTimer::summary(std::string_view stage) const {
  const auto found = stage_ms_.find(stage);
  return found == stage_ms_.end() ? StageSummary{} : summarise(found->second);
}

}  // namespace sheen::core
