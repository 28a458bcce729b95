// SPDX-License-Identifier: MIT
#include "fitting/guidance/quality_curve.h"

#include <algorithm>
#include <cmath>

namespace sheen::fitting::guidance {
namespace {

constexpr float kSmoothing = 0.1f;
constexpr double kSmallestError = 1e-5;  // 50 dB: beyond it there is nothing to see
constexpr std::size_t kWindow = 90;
constexpr float kNoticeable_db = 0.3f;
constexpr float kNoticeableCoverage = 0.01f;

}  // namespace

void QualityCurve::add(const FrameScore& score, double coverage) {
  if (score.predicted == 0) return;
  const auto psnr_db =
      static_cast<float>(-10 * std::log10(std::max(score.squared_error, kSmallestError)));
  const float last = psnr_db_.empty() ? psnr_db : psnr_db_.back();
  psnr_db_.push_back(last + kSmoothing * (psnr_db - last));
  coverage_.push_back(static_cast<float>(coverage));
}

bool QualityCurve::is_flat() const {
  if (psnr_db_.size() <= kWindow) return false;
  const std::size_t before = psnr_db_.size() - 1 - kWindow;
  return psnr_db_.back() - psnr_db_[before] < kNoticeable_db &&
         coverage_.back() - coverage_[before] < kNoticeableCoverage;
}

}  // namespace sheen::fitting::guidance
