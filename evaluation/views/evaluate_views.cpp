// SPDX-License-Identifier: MIT
#include "evaluation/views/evaluate_views.h"

#include "pipeline/posed_views.h"
#include "render/surface/object_mask.h"

namespace sheen::evaluation {

std::vector<EvaluationSummary> evaluate_views(
    render::Context& gl, const EvaluationViews& views, std::span<render::Renderer* const> renderers,
    const std::function<void(const ComparedView&)>& on_view) {
  render::ObjectMask object(gl, views.mesh);
  std::vector<std::vector<ViewError>> errors(renderers.size());
  std::vector<render::RenderedView> rendered(renderers.size());
  std::vector<ViewError> view_errors(renderers.size());
  pipeline::for_each_view(
      views.session, &views.mesh, views.frames,
      [&](const capture::Frame& frame, const Eigen::Isometry3d& camera_from_object) {
        const core::CameraModel& camera = views.session.camera_of(frame.index);
        const cv::Mat mask = object.seen_by(camera, camera_from_object);
        for (std::size_t i = 0; i < renderers.size(); ++i) {
          rendered[i] = renderers[i]->render(camera, camera_from_object);
          const auto error = compare_view(frame.index, rendered[i], frame.image, mask);
          if (!error) return;
          view_errors[i] = *error;
        }
        for (std::size_t i = 0; i < renderers.size(); ++i) errors[i].push_back(view_errors[i]);
        on_view({frame, mask, rendered, view_errors});
      });
  std::vector<EvaluationSummary> summaries;
  summaries.reserve(errors.size());
  for (auto& renderer_errors : errors) summaries.push_back(summarise(std::move(renderer_errors)));
  return summaries;
}

}  // namespace sheen::evaluation
