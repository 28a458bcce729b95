// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/v4l2_camera.h"

#include <memory>

namespace sheen::capture {

/// The camera that `wish.device` names: a device of the kernel, or an address in the network
/// (capture/source/network_camera.h), which takes no wishes. Throws core::Error as those do, and
/// bad_input for wishes to a network camera.
std::unique_ptr<Camera> open_camera(const V4l2CameraOptions& wish);

}  // namespace sheen::capture
