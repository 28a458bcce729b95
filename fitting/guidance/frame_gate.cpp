// SPDX-License-Identifier: MIT
#include "fitting/guidance/frame_gate.h"

#include "core/numerics/median.h"

#include <algorithm>
#include <cmath>

namespace sheen::fitting::guidance {
namespace {

constexpr std::size_t kRemembered = 31;
constexpr std::size_t kFirstLessons = 10;  // frames before anything is called unusual
constexpr std::size_t kFewest = 50;        // familiar samples that are enough for a judgement
constexpr double kUnusual = 3;             // times what is usual
constexpr double kCalm = 0.67;             // median size of a normal error, in its deviations
constexpr double kStep = 0.06;             // logarithm of a gain that is worth the name
constexpr double kExplained = 0.5;  // of the normalised residual is left without the gain, at most

}  // namespace

std::string_view name_of(FrameVerdict verdict) {
  switch (verdict) {
    case FrameVerdict::exposure_step:
      return "exposure_step";
    case FrameVerdict::mismatch:
      return "mismatch";
    case FrameVerdict::fine:
      break;
  }
  return "fine";
}

double FrameGate::usual_normalised_residual() const {
  std::vector<double> values = recent_;
  return std::max(core::upper_median(values), kCalm);
}

FrameVerdict FrameGate::judge(const FrameScore& score) {
  if (score.familiar < kFewest) return FrameVerdict::fine;
  if (recent_.size() >= kFirstLessons &&
      score.normalised_residual > kUnusual * usual_normalised_residual()) {
    const bool step =
        std::abs(std::log(score.gain)) > kStep &&
        score.normalised_residual_without_gain < kExplained * score.normalised_residual;
    return step ? FrameVerdict::exposure_step : FrameVerdict::mismatch;
  }
  if (recent_.size() < kRemembered) {
    recent_.push_back(score.normalised_residual);
  } else {
    recent_[next_++ % kRemembered] = score.normalised_residual;
  }
  return FrameVerdict::fine;
}

}  // namespace sheen::fitting::guidance
