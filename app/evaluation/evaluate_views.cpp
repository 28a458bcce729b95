// SPDX-License-Identifier: MIT
#include "app/evaluation/evaluate_views.h"

#include "app/evaluation/posed_views.h"

namespace sheen::app {

std::vector<EvaluationSummary> evaluate_views(
    const capture::Session& session, const std::vector<PosedFrame>& views,
    std::span<render::SurfaceRenderer* const> renderers,
    const std::function<void(const ComparedView&)>& on_view) {
  std::vector<std::vector<ViewError>> errors(renderers.size());
  std::vector<render::RenderedView> rendered(renderers.size());
  std::vector<ViewError> view_errors(renderers.size());
  for_each_view(session, views,
                [&](const capture::Frame& frame, const Eigen::Isometry3d& camera_from_object) {
                  for (std::size_t i = 0; i < renderers.size(); ++i) {
                    rendered[i] = renderers[i]->render(session.camera, camera_from_object);
                    const auto error = compare_view(frame.index, rendered[i], frame.image);
                    if (!error) return;
                    view_errors[i] = *error;
                  }
                  for (std::size_t i = 0; i < renderers.size(); ++i)
                    errors[i].push_back(view_errors[i]);
                  on_view({frame, rendered, view_errors});
                });
  std::vector<EvaluationSummary> summaries;
  summaries.reserve(errors.size());
  for (auto& renderer_errors : errors) summaries.push_back(summarise(std::move(renderer_errors)));
  return summaries;
}

}  // namespace sheen::app
