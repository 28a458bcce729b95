// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace sheen::app {

/// Why a frame was refused, for the person who holds the camera: the name of a PoseRejection or a
/// FrameVerdict in words. Unknown names come back as they are.
std::string reason_in_words(std::string_view name);

}  // namespace sheen::app
