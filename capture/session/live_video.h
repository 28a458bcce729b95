// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session_recorder.h"
#include "capture/source/camera.h"
#include "capture/source/frame_source.h"

#include <memory>

namespace sheen::capture {

/// The frames of a compressed video while it is recorded, decoded from its file as it grows, after
/// a fault of the disk from the pictures that did not come to it (`takes_unrecorded`: only one
/// reader may). They are those of a replay. The recorder is borrowed.
std::unique_ptr<FrameSource> open_live_video(SessionRecorder& recorder,
                                             const CameraDescription& camera,
                                             bool takes_unrecorded);

}  // namespace sheen::capture
