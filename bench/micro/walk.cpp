// SPDX-License-Identifier: MIT
#include "bench/micro/walk.h"

#include "capture/synthetic/camera_path.h"
#include "capture/synthetic/synthetic_session.h"
#include "capture/synthetic/torus_knot.h"

#include <algorithm>
#include <map>

namespace sheen::bench {
namespace {

constexpr int kViews = 12;

Walk make_walk(int vertices) {
  Walk walk{capture::synthetic::torus_knot(vertices),
            capture::synthetic::synthetic_camera(1280, 720),
            {}};
  double radius_m = 0;
  for (const Eigen::Vector3f& position : walk.mesh.positions) {
    radius_m = std::max(radius_m, static_cast<double>(position.norm()));
  }
  const capture::synthetic::CameraPath path(capture::synthetic::recording_path(1),
                                            Eigen::Vector3d::Zero(), radius_m);
  for (int view = 0; view < kViews; ++view) {
    walk.camera_from_object.push_back(
        path.board_from_camera(static_cast<double>(view) / kViews).inverse());
  }
  return walk;
}

}  // namespace

const Walk& walk_round(int vertices) {
  static std::map<int, Walk> walks;
  const auto [place, is_new] = walks.try_emplace(vertices);
  if (is_new) place->second = make_walk(vertices);
  return place->second;
}

}  // namespace sheen::bench
