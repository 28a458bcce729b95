// SPDX-License-Identifier: MIT
#include "exporters/upright.h"

#include <string_view>

namespace sheen::exporters {

fitting::FitOption up_option(std::string& up) {
  return {"up", "Axis of the object that points upwards", "x|y|z|-x|-y|-z",
          [&up](const std::string& given) { up = given; }, [&up] { return up; }};
}

void check_up(const std::string& up) {
  const bool is_axis = up.size() == 1 || (up.size() == 2 && up.front() == '-');
  if (!is_axis || std::string_view("xyz").find(up.back()) == std::string_view::npos) {
    fitting::refuse_value("up", up, "x|y|z|-x|-y|-z");
  }
}

fitting::OptionTable option_table(UprightOptions& options) {
  return {up_option(options.up)};
}

Eigen::Matrix3f y_up_from_object(const std::string& up) {
  const int axis = up.back() - 'x';
  const float sign = up.front() == '-' ? -1.0f : 1.0f;
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Zero();
  rotation.row(1)[axis] = sign;
  // x stays where it can; where it is what points up, y takes its place.
  rotation.row(0)[axis == 0 ? 1 : 0] = axis == 0 ? -sign : 1.0f;
  rotation.row(2) = rotation.row(0).cross(rotation.row(1));
  return rotation;
}

core::Mesh turned(const core::Mesh& mesh, const Eigen::Matrix3f& rotation) {
  core::Mesh result = mesh;
  for (Eigen::Vector3f& position : result.positions) position = rotation * position;
  for (Eigen::Vector3f& normal : result.normals) normal = rotation * normal;
  result.offset = rotation.cast<double>() * mesh.offset;
  return result;
}

}  // namespace sheen::exporters
