// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/session/session.h"
#include "core/mesh/mesh.h"
#include "fitting/heights/seen_texels.h"
#include "pipeline/options.h"
#include "pipeline/pose_stage.h"
#include "pipeline/progress_sink.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace sheen::pipeline {

using fitting::heights::PosedImage;

/// How many images of this camera are kept at once: at most 64, and at most 512 MiB.
std::size_t most_stills(const core::CameraModel& camera);

/// At most most_stills posed frames of those that `choice` fits, spread evenly over the recording:
/// those that are held out have no part. Poses are taken as they come from `poses`, frames without
/// one are passed over.
std::vector<PosedImage> read_stills(const capture::Session& session, const FrameChoice& choice,
                                    PoseStage& poses, ProgressSink& sink);

/// Whether these images tell anything about the mesh: not where the tags' corners show that another
/// lens was used, or that the board is bent. `board` is that of the tags that give the poses, if
/// they do. Says so to `sink` where they do not.
bool are_poses_sound(const capture::Session& session, const std::optional<capture::Board>& board,
                     const std::vector<PosedImage>& images, ProgressSink& sink);

/// Images that something about a mesh is measured with, and those that the outcome is checked on.
struct DividedStills {
  /// At most 64 of `images`, spread evenly; every fourth of them is a check view.
  explicit DividedStills(const std::vector<PosedImage>& images);

  /// What a pixel covers of `mesh`, metres; of views that are not empty.
  [[nodiscard]] float texel_m(const core::Mesh& mesh) const;

  std::vector<PosedImage> views, check_views;
};

}  // namespace sheen::pipeline
