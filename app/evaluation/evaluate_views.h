// SPDX-License-Identifier: MIT
#pragma once

#include "app/evaluation/view_evaluation.h"
#include "app/pipeline/frame_statistics.h"
#include "capture/session/session.h"
#include "render/surface/surface_renderer.h"

#include <functional>
#include <span>
#include <vector>

namespace sheen::app {

/// A view as photographed and as every renderer draws it.
struct ComparedView {
  const capture::Frame& photograph;
  std::span<const render::RenderedView> rendered;
  std::span<const ViewError> errors;
};

/// Renders every view (ascending by index) with each renderer and compares with the session's
/// images; views on which the mesh cannot be seen are left out. One summary per renderer.
std::vector<EvaluationSummary> evaluate_views(
    const capture::Session& session, const std::vector<PosedFrame>& views,
    std::span<render::SurfaceRenderer* const> renderers,
    const std::function<void(const ComparedView&)>& on_view);

}  // namespace sheen::app
