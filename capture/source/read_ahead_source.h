// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_source.h"

#include <memory>

namespace sheen::capture {

/// The same frames, decoded on a thread of their own while earlier ones are worked on; a few at
/// most wait. For decoders that cost more than the rest of a frame.
std::unique_ptr<FrameSource> read_ahead(std::unique_ptr<FrameSource> source);

}  // namespace sheen::capture
