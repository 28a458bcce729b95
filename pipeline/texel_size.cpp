// SPDX-License-Identifier: MIT
#include "pipeline/texel_size.h"

#include "core/mesh/parts.h"
#include "core/numerics/median.h"
#include "fitting/descriptor.h"
#include "fitting/detail/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace sheen::pipeline {

using fitting::detail::kTexelOption;

double pixel_footprint_m(std::span<const Eigen::Isometry3d> camera_from_object,
                         const Eigen::Vector3d& centre, double focal_px) {
  std::vector<double> distances_m;
  for (const Eigen::Isometry3d& pose : camera_from_object) {
    distances_m.push_back((pose * centre).norm());
  }
  return core::upper_median(distances_m) / focal_px;
}

bool asks_texel_size(std::string_view representation, const fitting::OptionValues& values) {
  if (values.contains(kTexelOption)) return false;
  const auto options = fitting::representation_named(representation).default_options();
  return std::ranges::any_of(options->table(),
                             [](const fitting::FitOption& o) { return o.name == kTexelOption; });
}

bool are_finer_than_vertices(double texel_m, const core::Mesh& mesh) {
  constexpr double least_per_vertex = 2;
  return texels_per_vertex(texel_m, mesh) >= least_per_vertex;
}

double texels_per_vertex(double texel_m, const core::Mesh& mesh) {
  double area_m2 = 0;
  for (const auto& triangle : mesh.triangles) {
    area_m2 += core::doubled_area(mesh, triangle).norm() / 2;
  }
  const auto vertices = static_cast<double>(mesh.positions.size());
  return area_m2 / (vertices * texel_m * texel_m);
}

void set_texel_size(double texel_m, fitting::OptionValues& values) {
  values[kTexelOption] = fmt::format(
      "{:.4g}",
      std::clamp(1000 * texel_m, fitting::detail::kLeastTexel_mm, fitting::detail::kMostTexel_mm));
}

}  // namespace sheen::pipeline
