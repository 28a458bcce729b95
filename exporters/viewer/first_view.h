// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/confidence/confidence.h"

#include <string>

namespace sheen::exporters::viewer {

/// From where the page shows the object first, all of it in the picture. Angles as in
/// web/viewer/camera.js.
struct FirstView {
  double azimuth_rad = -1;
  double elevation_rad = 0.5;
  Eigen::Vector3d towards_eye{0, 0, 1};  ///< object frame, unit length
};

/// Of a ring of views at a few heights the one that photographs support best; the usual one where
/// nobody kept count. `up` as in exporters/upright.h.
FirstView first_view(const core::Mesh& mesh, const fitting::SeenDirections& seen,
                     const std::string& up);

}  // namespace sheen::exporters::viewer
