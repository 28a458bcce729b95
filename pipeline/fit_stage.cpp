// SPDX-License-Identifier: MIT
#include "pipeline/fit_stage.h"

#include "pipeline/evidence/capture_evidence.h"

#include <utility>

namespace sheen::pipeline {

FitStage::FitStage(Parts parts) : parts_(std::move(parts)) {
  statistics_.seen.resize(parts_.mesh.positions.size());
  if (parts_.photometric.refine_poses || parts_.photometric.exposure) {
    aligner_.emplace(parts_.mesh, parts_.photometric.pose_error_px);
  }
}

void FitStage::integrate(TrackedFrame& tracked) {
  auto posed = statistics_.count(tracked);
  if (!posed) return;
  if (parts_.hold_out.contains(posed->index)) {
    statistics_.held_out.push_back(*posed);
  } else {
    observe(tracked.frame, tracked.times, *posed);
  }
  statistics_.posed.push_back(*posed);
}

void FitStage::observe(const capture::Frame& frame, core::StageTimes& times, PosedFrame& posed) {
  const PosedFrame tracked = posed;
  // Find out which vertices are seen, and refine the pose.
  const core::CameraModel& camera = parts_.session.camera_of(frame.index);
  Eigen::Isometry3d camera_from_object = posed.camera_from_board * parts_.session.board_from_object;
  {
    const auto timing = times.measure("visibility");
    parts_.observer.see(camera, camera_from_object);
  }
  if (parts_.photometric.refine_poses) {
    const auto timing = times.measure("align");
    if (const auto alignment = align(frame, posed)) {
      statistics_.refined_px.push_back(alignment->motion_px);
      camera_from_object = alignment->camera_from_object;
      parts_.observer.see(camera, camera_from_object);
    }
  }

  // Read the image.
  core::SampleBatch* samples = nullptr;
  cv::Mat depth_m;
  {
    const auto timing = times.measure("sample");
    samples = &parts_.observer.sample(frame.image);
    if (parts_.depth != nullptr) depth_m = parts_.depth->read(frame.index);
  }
  double gain = 1;
  if (parts_.photometric.exposure) {
    const auto timing = times.measure("align");
    gain = correct_exposure(*samples);
  }
  parts_.share.keep(parts_.mesh.positions.size(), *samples);
  const auto counts = core::count_rejections(parts_.observer.view());
  for (std::size_t i = 0; i < counts.size(); ++i) statistics_.vertex_rejections[i] += counts[i];

  // Fit, unless somebody objects.
  if (parts_.admit && !parts_.admit(*samples)) {
    ++statistics_.frames_refused;
    return;
  }
  fitting::note_seen(*samples, statistics_.seen);
  integrated_.push_back({frame.index, camera_from_object, gain, tracked});
  const core::Observation observation{
      frame.index, frame.image, camera, camera_from_object, parts_.observer.view(),
      *samples,    gain,        depth_m};
  {
    const auto timing = times.measure("evidence");
    parts_.evidence.look_at(frame, posed.camera_from_board, observation);
  }
  fit(observation, times);
}

void FitStage::fit(const core::Observation& observation, core::StageTimes& times) {
  if (parts_.on_samples) parts_.on_samples(observation.frame_index, observation.samples);
  if (aligner_) aligner_->note_integrated(observation.samples);
  if (parts_.mean != nullptr) {
    const auto timing = times.measure("baseline");
    parts_.mean->integrate(observation);
  }
  const auto timing = times.measure("fit");
  parts_.model.integrate(observation);
  ++statistics_.frames_fitted;
}

PosedFrame FitStage::refined(const capture::Frame& frame, PosedFrame posed) {
  parts_.observer.see(parts_.session.camera_of(frame.index),
                      posed.camera_from_board * parts_.session.board_from_object);
  align(frame, posed);
  return posed;
}

std::optional<core::Alignment> FitStage::align(const capture::Frame& frame, PosedFrame& posed) {
  const auto alignment = parts_.model.with([&](const fitting::Fitter& fitter) {
    return aligner_->align(frame.image, parts_.observer.view(),
                           fitting::require_patches(fitter.light_field(), "--refine-poses"),
                           parts_.session.camera_of(frame.index),
                           posed.camera_from_board * parts_.session.board_from_object);
  });
  if (alignment) {
    posed.camera_from_board =
        alignment->camera_from_object * parts_.session.board_from_object.inverse();
  }
  return alignment;
}

double FitStage::correct_exposure(core::SampleBatch& batch) {
  const auto gain = parts_.model.with([&](const fitting::Fitter& fitter) {
    return aligner_->gain(batch, fitting::require_patches(fitter.light_field(), "--exposure"));
  });
  if (!gain) return 1;
  statistics_.gains.push_back(*gain);
  divide_by_gain(*gain, batch);
  return *gain;
}

}  // namespace sheen::pipeline
