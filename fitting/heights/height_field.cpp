// SPDX-License-Identifier: MIT
#include "fitting/heights/height_field.h"

#include "core/mesh/parts.h"
#include "core/mesh/repair.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace sheen::fitting::heights {
namespace {

/// Normals of the shape alone.
std::vector<Eigen::Vector3f> shape_normals(core::Mesh mesh) {
  mesh.normals.clear();
  core::complete_normals(mesh);
  return std::move(mesh.normals);
}

}  // namespace

HeightField::HeightField(const core::Mesh& mesh)
    : mesh_(mesh), index_(core::first_at_position(mesh)) {
  // Number the first vertices at their positions; `first` of a vertex is never above it.
  std::vector<Eigen::Vector3f> position;
  for (std::size_t i = 0; i < index_.size(); ++i) {
    if (index_[i] == i) {
      index_[i] = static_cast<std::uint32_t>(direction_.size());
      direction_.push_back(mesh.normals[i]);
      position.push_back(mesh.positions[i]);
    } else {
      index_[i] = index_[index_[i]];
      direction_[index_[i]] += mesh.normals[i];
    }
  }
  for (Eigen::Vector3f& direction : direction_) {
    const float length = direction.norm();
    direction = length > 1e-3f ? Eigen::Vector3f(direction / length) : Eigen::Vector3f::Zero();
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  pairs.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      pairs.push_back(std::minmax({index_[triangle[corner]], index_[triangle[(corner + 1) % 3]]}));
    }
  }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto& [first, second] : pairs) {
    const float length_m = (position[first] - position[second]).norm();
    if (length_m > 0.0f) edges_.push_back({first, second, length_m});
  }
  height_.setZero(static_cast<Eigen::Index>(direction_.size()));
}

core::Mesh HeightField::raised() const {
  core::Mesh raised = mesh_;
  for (std::size_t i = 0; i < raised.positions.size(); ++i) {
    const auto height = static_cast<float>(height_[static_cast<Eigen::Index>(index_[i])]);
    raised.positions[i] += height * direction_[index_[i]];
  }
  const std::vector<Eigen::Vector3f> before = shape_normals(mesh_);
  const std::vector<Eigen::Vector3f> after = shape_normals(raised);
  for (std::size_t i = 0; i < raised.normals.size(); ++i) {
    if (before[i] == after[i]) continue;
    raised.normals[i] =
        (Eigen::Quaternionf::FromTwoVectors(before[i], after[i]) * raised.normals[i]).normalized();
  }
  return raised;
}

}  // namespace sheen::fitting::heights
