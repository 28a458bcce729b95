// SPDX-License-Identifier: MIT
#include "render/views/ray_grid.h"

#include <cstddef>
#include <limits>

namespace sheen::render {
namespace {

constexpr int kStep_px = 4;
/// Of the image, which reaches from here.
constexpr double kCorner_px = -0.5;

}  // namespace

RayGrid::RayGrid(const core::CameraModel& camera)
    : camera_(camera),
      columns_((camera.width_px() + kStep_px - 1) / kStep_px + 1),
      rows_((camera.height_px() + kStep_px - 1) / kStep_px + 1) {
  nodes_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      nodes_.push_back(exact(kCorner_px + i * kStep_px, kCorner_px + j * kStep_px));
    }
  }
}

Eigen::Vector2f RayGrid::exact(double x_px, double y_px) const {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  const auto ray = camera_.unproject({x_px, y_px});
  return ray ? Eigen::Vector2f(ray->head<2>().cast<float>()) : Eigen::Vector2f(none, none);
}

Eigen::Vector2f RayGrid::at(double x_px, double y_px) const {
  const double x = (x_px - kCorner_px) / kStep_px;
  const double y = (y_px - kCorner_px) / kStep_px;
  if (!(x >= 0 && y >= 0 && x < columns_ - 1 && y < rows_ - 1)) return exact(x_px, y_px);
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const auto u = static_cast<float>(x - column);
  const auto v = static_cast<float>(y - row);
  const Eigen::Vector2f* const upper =
      nodes_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + column;
  const Eigen::Vector2f* const lower = upper + columns_;
  const Eigen::Vector2f ray =
      (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
  return ray.allFinite() ? ray : exact(x_px, y_px);
}

}  // namespace sheen::render
