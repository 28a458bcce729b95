// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "core/mesh/mesh.h"
#include "pipeline/frame_statistics.h"

#include <functional>
#include <vector>

namespace sheen::pipeline {

/// Reads the session's frames again and calls `visit` with each frame of `views` (ascending by
/// index) and its pose. Images are not kept in memory between the fit and the evaluation. They
/// are corrected as for the fit (FrameCorrections) with `mesh`, null where there is none.
void for_each_view(const capture::Session& session, const core::Mesh* mesh,
                   const std::vector<PosedFrame>& views,
                   const std::function<void(const capture::Frame&,
                                            const Eigen::Isometry3d& camera_from_object)>& visit);

}  // namespace sheen::pipeline
