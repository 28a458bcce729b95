// SPDX-License-Identifier: MIT
#include "pipeline/evidence/depth_evidence.h"

#include "core/numerics/median.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostRatios = 16, kRatioSpacing = 4;
/// Sensors and meshes are not off by as much, units by far more.
constexpr double kOff = 1.2;

}  // namespace

DepthEvidence::DepthEvidence(double unit_m)
    : unit_m_(unit_m), ratios_(kMostRatios, kRatioSpacing) {}

void DepthEvidence::look_at(const core::Observation& observation) {
  if (observation.depth_m.empty() || !ratios_.is_due()) return;
  const core::VertexView& view = observation.view;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < view.rejection.size(); ++i) {
    if (view.rejection[i] != core::VertexRejection::none) continue;
    const auto x = static_cast<int>(std::lround(view.x_px[i]));
    const auto y = static_cast<int>(std::lround(view.y_px[i]));
    const auto depth_m = static_cast<double>(observation.depth_m.at<float>(y, x));
    if (depth_m > 0) ratios.push_back(depth_m / static_cast<double>(view.depth_m[i]));
  }
  if (!ratios.empty()) ratios_.add(core::upper_median(ratios));
}

std::optional<Finding> DepthEvidence::finding() const {
  std::vector<double> ratios = ratios_.items();
  if (ratios.empty()) return std::nullopt;
  const double ratio = core::upper_median(ratios);
  if (ratio < kOff && ratio > 1 / kOff) return std::nullopt;
  return Finding{
      "depth-unit",
      fmt::format("the depth images have the object {:.3g} times as far away as mesh and "
                  "pose do; \"unit_m\" of \"depth\" in session.json is {:g}, {:.3g} would "
                  "fit",
                  ratio, unit_m_, unit_m_ / ratio)};
}

}  // namespace sheen::pipeline
