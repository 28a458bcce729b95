// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_source.h"

#include <memory>

namespace sheen::capture {

/// The same frames, none sooner than it was recorded: one second after the first comes what was
/// taken one second after it. Who falls behind, or pauses, is not hurried: the clock waits. Frames
/// without time come at once.
std::unique_ptr<FrameSource> at_recorded_pace(std::unique_ptr<FrameSource> recording);

}  // namespace sheen::capture
