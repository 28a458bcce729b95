// SPDX-License-Identifier: MIT
#include "pipeline/observation_replay.h"

namespace sheen::pipeline {

void replay_observations(const capture::Session& session, std::span<const IntegratedView> views,
                         ViewObserver& observer, const capture::DepthImages* depth,
                         const std::function<void(const core::Observation&)>& observe) {
  if (views.empty()) return;
  const auto frames =
      capture::open_frames(session, views.front().frame_index, views.back().frame_index + 1);
  auto view = views.begin();
  while (view != views.end()) {
    const auto frame = frames->next();
    if (!frame) break;
    if (frame->index != view->frame_index) continue;
    const core::CameraModel& camera = session.camera_of(frame->index);
    observer.see(camera, view->camera_from_object);
    core::SampleBatch& samples = observer.sample(frame->image);
    if (view->gain != 1) divide_by_gain(view->gain, samples);
    observe({frame->index, frame->image, camera, view->camera_from_object, observer.view(), samples,
             view->gain, depth != nullptr ? depth->read(frame->index) : cv::Mat()});
    ++view;
  }
}

}  // namespace sheen::pipeline
