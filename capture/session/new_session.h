// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"

#include <filesystem>

namespace sheen::capture {

/// Makes a session of a video file or of a folder of pictures: their frames and nothing else, so
/// that it is unfinished. Pictures are numbered in the order of their names. Files are linked where
/// the file system lets them be in two places, else copied. Written beside its final name and moved
/// into place. Throws core::Error (bad_input): nothing to take frames from, pictures of several
/// formats, a name that is taken.
void write_new_session(const std::filesystem::path& source, const std::filesystem::path& folder);

/// As open_session, of a session that may lack camera and board (`camera_file` and `board` are
/// empty then). The camera of one that lacks it is only a guess, at the size of its images.
Session open_unfinished_session(const std::filesystem::path& folder);

}  // namespace sheen::capture
