// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"

#include <filesystem>
#include <span>
#include <vector>

namespace sheen::capture {

/// The files of some frames (by index) of a session of photographs, where any program reads the
/// pictures from them that the session's frames are: JPEG or PNG, not to be turned, colours in
/// sRGB. Empty when one is not such a file, or the session is a video.
std::vector<std::filesystem::path> plain_pictures(const Session& session,
                                                  std::span<const int> frames);

}  // namespace sheen::capture
