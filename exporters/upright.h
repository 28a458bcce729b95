// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/option_table.h"

#include <Eigen/Core>

#include <string>

namespace sheen::exporters {

/// "--up AXIS": the axis of the object that points upwards.
fitting::FitOption up_option(std::string& up);

/// Throws std::invalid_argument for other text than x, y, z, -x, -y and -z.
void check_up(const std::string& up);

/// The only setting of some formats.
struct UprightOptions {
  std::string up = "z";
  void check() const { check_up(up); }
};
fitting::OptionTable option_table(UprightOptions& options);

/// The quarter turns that let `up` point along +y, as glTF and many programs have it: a rotation of
/// ones and zeros, which loses no digit.
Eigen::Matrix3f y_up_from_object(const std::string& up);

/// The mesh, turned.
core::Mesh turned(const core::Mesh& mesh, const Eigen::Matrix3f& rotation);

}  // namespace sheen::exporters
