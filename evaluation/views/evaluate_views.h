// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "core/mesh/mesh.h"
#include "evaluation/views/view_evaluation.h"
#include "pipeline/frame_statistics.h"
#include "render/context/context.h"
#include "render/renderer.h"

#include <functional>
#include <span>
#include <vector>

namespace sheen::evaluation {

/// A view as photographed and as every renderer draws it.
struct ComparedView {
  const capture::Frame& photograph;
  const cv::Mat& mask;  ///< CV_8UC1: 255 where the object is seen
  std::span<const render::RenderedView> rendered;
  std::span<const ViewError> errors;
};

/// What views are compared on: images of a session and the mesh that says where the object is.
struct EvaluationViews {
  const capture::Session& session;
  const core::Mesh& mesh;
  const std::vector<pipeline::PosedFrame>& frames;  ///< ascending by index
};

/// Renders every view with each renderer and compares with the session's images; views on which the
/// mesh cannot be seen are left out. One summary per renderer. What `on_view` throws ends it.
std::vector<EvaluationSummary> evaluate_views(
    render::Context& gl, const EvaluationViews& views, std::span<render::Renderer* const> renderers,
    const std::function<void(const ComparedView&)>& on_view);

}  // namespace sheen::evaluation
