// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/v4l2_controls.h"
#include "capture/source/v4l2_modes.h"
#include "capture/source/v4l2_system.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sheen::capture {

/// A camera of this machine and what it offers.
struct CameraListing {
  std::filesystem::path device;  ///< /dev/video0
  std::string name;
  std::string bus = {};                      ///< where it is plugged in
  std::vector<CameraMode> modes = {};        ///< in a format that can be read; may be empty
  std::vector<CameraControl> controls = {};  ///< with their present values
  std::string fault = {};                    ///< why it could not be asked, else empty
};

/// Every camera of the machine. Video devices that are not cameras are left out; one that cannot
/// be opened is listed with the reason.
[[nodiscard]] std::vector<CameraListing> list_cameras(V4l2System& system);

}  // namespace sheen::capture
