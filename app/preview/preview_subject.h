// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/light_field.h"

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace sheen::app {

class LiveSession;

/// Facts about a finished model, name and value.
using ModelFacts = std::vector<std::pair<std::string, std::string>>;

/// What a window is opened for: a finished light field, or a session that is building one. Exactly
/// one of `light_field` and `live` is set; what is pointed to outlives the window.
struct PreviewSubject {
  std::string title;
  const core::Mesh& mesh;
  Eigen::Vector3d up;  ///< upright axis in the object frame
  const fitting::LightField* light_field = nullptr;
  ModelFacts facts = {};  ///< of a finished light field
  LiveSession* live = nullptr;
  std::filesystem::path snapshot_folder = {};
};

}  // namespace sheen::app
