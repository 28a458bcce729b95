// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/depth_images.h"
#include "capture/session/session.h"
#include "pipeline/fit_stage.h"
#include "pipeline/view_observer.h"

#include <functional>
#include <span>

namespace sheen::pipeline {

/// Observes frames of a session once more, exactly as they were integrated: for fitters that look
/// at images, which nobody keeps in memory. `views` are those wanted, frames ascending; `depth` may
/// be null. `mesh` is the object's, as when they were integrated.
void replay_observations(const capture::Session& session, const core::Mesh& mesh,
                         std::span<const IntegratedView> views, ViewObserver& observer,
                         const capture::DepthImages* depth,
                         const std::function<void(const core::Observation&)>& observe);

}  // namespace sheen::pipeline
