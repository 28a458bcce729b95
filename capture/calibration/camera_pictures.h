// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/camera.h"
#include "capture/source/frame_source.h"

#include <memory>

namespace sheen::capture {

/// Three pictures a second from a live camera, for `seconds` after the first: time to move the
/// target on. A picture that came damaged is passed over. `next` throws core::Error (run_failed)
/// when the camera is gone.
std::unique_ptr<FrameSource> open_camera_pictures(std::unique_ptr<Camera> camera, double seconds);

}  // namespace sheen::capture
