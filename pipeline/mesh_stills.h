// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "core/mesh/mesh.h"
#include "fitting/heights/seen_texels.h"
#include "pipeline/options.h"
#include "pipeline/pose_stage.h"
#include "pipeline/progress_sink.h"

#include <vector>

namespace sheen::pipeline {

using fitting::heights::PosedImage;

/// At most 64 posed frames of those that `choice` fits, spread evenly over the recording: those
/// that are held out have no part. Their images stay in memory, of large ones fewer are taken: at
/// most 512 MiB. Poses are taken as they come from `poses`, frames without one are passed over.
std::vector<PosedImage> read_stills(const capture::Session& session, const FrameChoice& choice,
                                    PoseStage& poses, ProgressSink& sink);

/// Images that something about a mesh is measured with, and those that the outcome is checked on.
struct DividedStills {
  /// At most 64 of `images`, spread evenly; every fourth of them is a check view.
  explicit DividedStills(const std::vector<PosedImage>& images);

  /// What a pixel covers of `mesh`, metres; of views that are not empty.
  [[nodiscard]] float texel_m(const core::Mesh& mesh) const;

  std::vector<PosedImage> views, check_views;
};

}  // namespace sheen::pipeline
