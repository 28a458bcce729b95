// SPDX-License-Identifier: MIT
#pragma once

#include "app/pipeline/model_stage.h"
#include "app/pipeline/pose_stage.h"
#include "core/diagnostics/stage_timer.h"

#include <functional>

namespace sheen::app {

/// Runs both stages to the end of the recording and returns the times of every frame. With
/// `overlap` the pose of the next frames is found while a frame is fitted, on a thread of its own;
/// the model is the same. `on_frame` is called on the calling thread, which fits, after every
/// frame, in order; what it throws ends the run. A frame is never dropped: whoever is ahead waits.
/// Exceptions of the stages and Interrupted come out here.
core::StageTimer run_pipeline(PoseStage& poses, ModelStage& model, bool overlap,
                              const std::function<void(const TrackedFrame&)>& on_frame);

}  // namespace sheen::app
