// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/camera.h"
#include "capture/source/frame_source.h"

#include <memory>

namespace sheen::capture {

/// Three images a second from a live camera, for `seconds` after the first: time to move the
/// target on. An image that came damaged is passed over. `next` throws core::Error (run_failed)
/// when the camera is gone.
std::unique_ptr<FrameSource> open_camera_images(std::unique_ptr<Camera> camera, double seconds);

}  // namespace sheen::capture
