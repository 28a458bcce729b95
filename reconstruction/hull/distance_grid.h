// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <vector>

namespace sheen::reconstruction {

/// A signed distance on the points of a regular grid: negative inside the object, metres, board
/// frame. x runs fastest.
class DistanceGrid {
 public:
  DistanceGrid() = default;
  /// Grid over `box` with points `cell_m` apart, all at `value`.
  DistanceGrid(const Eigen::AlignedBox3f& box, float cell_m, float value);

  [[nodiscard]] const Eigen::Array3i& size() const { return size_; }
  [[nodiscard]] float cell_m() const { return cell_m_; }
  [[nodiscard]] std::size_t count() const { return values_.size(); }
  [[nodiscard]] Eigen::AlignedBox3f box() const {
    return {first_m_, point(size_.x() - 1, size_.y() - 1, size_.z() - 1)};
  }

  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] Eigen::Vector3f point(int x, int y, int z) const {
    return first_m_ + cell_m_ * Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y),
                                                static_cast<float>(z));
  }
  [[nodiscard]] Eigen::Vector3f point(std::size_t index) const;

  /// Place of a point in cells, from the first grid point.
  [[nodiscard]] Eigen::Vector3f cell_of(const Eigen::Vector3f& point_m) const {
    return (point_m - first_m_) / cell_m_;
  }

  [[nodiscard]] float& operator[](std::size_t index) { return values_[index]; }
  [[nodiscard]] float operator[](std::size_t index) const { return values_[index]; }

  /// Limits every value to +-`limit_m` and blurs them (binomial, 1 2 1 along each axis) `rounds`
  /// times.
  void smooth(float limit_m, int rounds, int threads);

  /// Takes away what lies below a height.
  void cut_below(float z_m);

  /// Trilinear value; outside the grid that of its nearest place.
  [[nodiscard]] float value_at(const Eigen::Vector3f& point_m) const;
  /// Trilinear value's gradient by central differences of half a cell; not normalised.
  [[nodiscard]] Eigen::Vector3f gradient_at(const Eigen::Vector3f& point_m) const;

 private:
  Eigen::Vector3f first_m_ = Eigen::Vector3f::Zero();
  float cell_m_ = 0;
  Eigen::Array3i size_ = Eigen::Array3i::Zero();
  std::vector<float> values_;
};

}  // namespace sheen::reconstruction
