// SPDX-License-Identifier: MIT
#pragma once

#include "core/diagnostics/stage_timer.h"
#include "pipeline/pose_stage.h"

#include <functional>

namespace sheen::pipeline {

/// Poses every frame to the end of the recording and hands it to `take`, in order, on the calling
/// thread; returns the times of every frame. With `overlap` the pose of the next frames is found
/// meanwhile, on a thread of its own; the result is the same. A frame is never dropped: whoever is
/// ahead waits. What either side throws ends the loop and comes out here.
core::StageTimer for_each_frame(PoseStage& poses, bool overlap,
                                const std::function<void(TrackedFrame&)>& take);

}  // namespace sheen::pipeline
