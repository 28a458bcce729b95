// SPDX-License-Identifier: MIT
#include "pipeline/texel_size.h"

#include "core/numerics/median.h"
#include "fitting/descriptor.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace sheen::pipeline {
namespace {

constexpr const char* kOption = "texel-mm";

}  // namespace

double pixel_footprint_m(std::span<const Eigen::Isometry3d> camera_from_object,
                         const Eigen::Vector3d& centre, double focal_px) {
  std::vector<double> distances_m;
  for (const Eigen::Isometry3d& pose : camera_from_object) {
    distances_m.push_back((pose * centre).norm());
  }
  return core::upper_median(distances_m) / focal_px;
}

bool asks_texel_size(std::string_view representation, const fitting::OptionValues& values) {
  if (values.contains(kOption)) return false;
  const auto options = fitting::representation_named(representation).default_options();
  return std::ranges::any_of(options->table(),
                             [](const fitting::FitOption& o) { return o.name == kOption; });
}

void set_texel_size(double texel_m, fitting::OptionValues& values) {
  constexpr double least_mm = 1e-4;  // as the option allows
  constexpr double most_mm = 1e4;
  values[kOption] = fmt::format("{:.4g}", std::clamp(1000 * texel_m, least_mm, most_mm));
}

}  // namespace sheen::pipeline
