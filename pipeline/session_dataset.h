// SPDX-License-Identifier: MIT
#pragma once

#include "capture/dataset/dataset.h"
#include "capture/session/session.h"
#include "pipeline/options.h"
#include "pipeline/progress_sink.h"

#include <filesystem>

namespace sheen::pipeline {

struct DatasetOptions {
  FrameChoice frames{};    ///< `hold_out` marks frames, it leaves none out
  bool undistort = false;  ///< images as a camera without distortion would have taken them
  int threads = 1;
};

/// A session as other programs want it, in the board's axes and in metres. Takes the frames that a
/// replay takes, and writes into `folder`, which exists: images/ (the session's files where any
/// program reads them alike, else PNG), masks/ (the object, from its mesh; the image's name with
/// .png behind) and object.ply (the mesh in the same axes with its mean colours, whose vertices are
/// the points that other programs begin from). Throws core::Error as a replay does.
capture::Dataset write_session_dataset(const capture::Session& session,
                                       const DatasetOptions& options,
                                       const std::filesystem::path& folder, ProgressSink& sink);

}  // namespace sheen::pipeline
