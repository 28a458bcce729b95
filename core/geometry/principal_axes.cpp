// SPDX-License-Identifier: MIT
#include "core/geometry/principal_axes.h"

#include <Eigen/SVD>

namespace sheen::core {

PrincipalAxes principal_axes(const Eigen::Matrix3Xd& points) {
  const Eigen::Vector3d mean = points.rowwise().mean();
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(points.colwise() - mean, Eigen::ComputeFullU);
  return {mean, svd.matrixU(), svd.singularValues()};
}

}  // namespace sheen::core
