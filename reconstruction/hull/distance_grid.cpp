// SPDX-License-Identifier: MIT
#include "reconstruction/hull/distance_grid.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <cmath>

namespace sheen::reconstruction {

DistanceGrid::DistanceGrid(const Eigen::AlignedBox3f& box, float cell_m, float value)
    : first_m_(box.min()), cell_m_(cell_m) {
  for (int axis = 0; axis < 3; ++axis) {
    size_[axis] = 1 + std::max(1, static_cast<int>(std::ceil(box.sizes()[axis] / cell_m)));
  }
  values_.assign(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                     static_cast<std::size_t>(size_.z()),
                 value);
}

Eigen::Vector3f DistanceGrid::point(std::size_t index) const {
  const auto nx = static_cast<std::size_t>(size_.x());
  const auto ny = static_cast<std::size_t>(size_.y());
  return point(static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
               static_cast<int>(index / nx / ny));
}

float DistanceGrid::value_at(const Eigen::Vector3f& point_m) const {
  const Eigen::Vector3f place = cell_of(point_m);
  std::array<int, 3> low{};
  std::array<float, 3> share{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const float clamped = std::clamp(place[axis], 0.0F, static_cast<float>(size_[axis] - 1));
    low[i] = std::min(static_cast<int>(clamped), size_[axis] - 2);
    share[i] = clamped - static_cast<float>(low[i]);
  }
  const std::size_t first = index(low[0], low[1], low[2]);
  const auto nx = static_cast<std::size_t>(size_.x());
  const std::size_t layer = nx * static_cast<std::size_t>(size_.y());
  const auto line = [&](std::size_t i) {
    return values_[i] + share[0] * (values_[i + 1] - values_[i]);
  };
  const auto plane = [&](std::size_t i) {
    const float a = line(i);
    return a + share[1] * (line(i + nx) - a);
  };
  const float a = plane(first);
  return a + share[2] * (plane(first + layer) - a);
}

void DistanceGrid::smooth(float limit_m, int rounds, int threads) {
  for (float& value : values_) value = std::clamp(value, -limit_m, limit_m);
  const std::array<std::size_t, 3> stride{
      1, static_cast<std::size_t>(size_.x()),
      static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y())};
  std::vector<float> blurred(values_.size());
  for (int round = 0; round < rounds; ++round) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t step = stride[static_cast<std::size_t>(axis)];
      const auto length = static_cast<std::size_t>(size_[axis]);
      core::parallel_for(values_.size(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const std::size_t place = i / step % length;
          const float before = place > 0 ? values_[i - step] : values_[i];
          const float after = place + 1 < length ? values_[i + step] : values_[i];
          blurred[i] = 0.25F * before + 0.5F * values_[i] + 0.25F * after;
        }
      });
      values_.swap(blurred);
    }
  }
}

void DistanceGrid::cut_below(float z_m) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    values_[i] = std::max(values_[i], z_m - point(i).z());
  }
}

Eigen::Vector3f DistanceGrid::gradient_at(const Eigen::Vector3f& point_m) const {
  const float h = 0.5F * cell_m_;
  Eigen::Vector3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3f step = Eigen::Vector3f::Zero();
    step[axis] = h;
    gradient[axis] = (value_at(point_m + step) - value_at(point_m - step)) / (2 * h);
  }
  return gradient;
}

}  // namespace sheen::reconstruction
