// SPDX-License-Identifier: MIT
#pragma once

#include "capture/registration/registration.h"
#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <functional>
#include <vector>

namespace sheen::capture {

/// Where an upright object stands when only its turn about z is unknown: of twelve first guesses,
/// each registered on a few of `views`, the one whose outline finds most edges
/// (board_from_object). `on_guess` is called before each; what it throws ends the search.
Eigen::Isometry3d find_upright_turn(const core::Mesh& mesh, const core::CameraModel& camera,
                                    const std::vector<RegistrationView>& views,
                                    const std::function<void()>& on_guess);

/// At most `most` of `all`, spread evenly.
template <typename T>
std::vector<T> thinned_out(const std::vector<T>& all, std::size_t most) {
  const std::size_t count = std::min(all.size(), most);
  std::vector<T> some;
  for (std::size_t i = 0; i < count; ++i) {
    some.push_back(all[(2 * i + 1) * all.size() / (2 * count)]);
  }
  return some;
}

}  // namespace sheen::capture
