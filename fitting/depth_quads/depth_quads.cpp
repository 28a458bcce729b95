// SPDX-License-Identifier: MIT
#include "fitting/depth_quads/depth_quads.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace sheen::fitting::depth_quads {
namespace {

constexpr std::size_t kProbes = 16;

/// Middles of some quads of the finest level, evenly among them.
std::vector<Eigen::Vector3d> probes_of(const KeptView& photograph, const QuadLevel& level,
                                       const QuadDepths& depths) {
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < level.size(); ++cell) {
    if (depths.codes[cell] != 0) cells.push_back(cell);
  }
  const Eigen::Isometry3d object_from_camera = photograph.camera_from_object.inverse();
  const auto columns = static_cast<std::size_t>(level.columns);
  const std::size_t count = std::min(kProbes, cells.size());
  std::vector<Eigen::Vector3d> probes;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t cell = cells[(2 * i + 1) * cells.size() / (2 * count)];
    const cv::Point middle = photograph.crop.tl() +
                             level.spacing_px * cv::Point(static_cast<int>(cell % columns),
                                                          static_cast<int>(cell / columns)) +
                             cv::Point(level.spacing_px / 2, level.spacing_px / 2);
    const auto ray = photograph.camera.unproject({middle.x, middle.y});
    if (!ray) continue;
    probes.push_back(object_from_camera *
                     (static_cast<double>(depths.depth_m(depths.codes[cell])) * *ray));
  }
  // All of it beyond the lens model: nothing will be drawn, but it is somewhere.
  if (probes.empty()) probes.push_back(object_from_camera.translation());
  return probes;
}

}  // namespace

std::size_t DepthQuads::coefficient_count() const {
  std::size_t count = means_.coefficient_count();
  for (std::size_t i = 0; i < photographs_.size(); ++i) {
    count +=
        3 * static_cast<std::size_t>(photographs_[i].crop.area()) + quads_[i].depths.codes.size();
  }
  return count;
}

void DepthQuads::add(KeptView photograph, QuadDepths depths) {
  auto levels = quad_levels(photograph.crop.size(), options_.spacing_px, options_.levels);
  auto probes = probes_of(photograph, levels.front(), depths);
  photographs_.push_back(std::move(photograph));
  quads_.push_back({std::move(depths), std::move(levels), std::move(probes)});
}

}  // namespace sheen::fitting::depth_quads
