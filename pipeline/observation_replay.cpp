// SPDX-License-Identifier: MIT
#include "pipeline/observation_replay.h"

#include "pipeline/frame_corrections.h"

namespace sheen::pipeline {

void replay_observations(const capture::Session& session, const core::Mesh& mesh,
                         std::span<const IntegratedView> views, ViewObserver& observer,
                         const capture::DepthImages* depth,
                         const std::function<void(const core::Observation&)>& observe) {
  if (views.empty()) return;
  const auto frames =
      capture::open_frames(session, views.front().frame_index, views.back().frame_index + 1);
  FrameCorrections corrections(session, &mesh, 1);
  auto view = views.begin();
  while (view != views.end()) {
    const auto read = frames->next();
    if (!read) break;
    if (read->index != view->frame_index) continue;
    const capture::Frame frame =
        corrections.correct(*read, view->tracked.camera_from_board, view->tracked.readout_motion);
    const core::CameraModel& camera = session.camera_of(frame.index);
    observer.see(camera, view->camera_from_object);
    core::SampleBatch& samples = observer.sample(frame.image);
    if (view->gain != 1) divide_by_gain(view->gain, samples);
    observe({frame.index, frame.image, camera, view->camera_from_object, observer.view(), samples,
             view->gain, depth != nullptr ? depth->read(frame.index) : cv::Mat()});
    ++view;
  }
}

}  // namespace sheen::pipeline
