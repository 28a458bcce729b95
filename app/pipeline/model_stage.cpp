// SPDX-License-Identifier: MIT
#include "app/pipeline/model_stage.h"

#include "core/samples/back_projection.h"

namespace sheen::app {

ModelStage::ModelStage(Parts parts)
    : parts_(std::move(parts)), points_(core::surface_points(parts_.mesh)) {
  if (parts_.photometric.refine_poses || parts_.photometric.exposure)
    aligner_.emplace(parts_.mesh, parts_.photometric.pose_error_px);
}

void ModelStage::integrate(TrackedFrame& tracked) {
  auto posed = count(tracked);
  if (!posed) return;
  if (parts_.hold_out.contains(posed->index)) {
    statistics_.held_out.push_back(*posed);
  } else {
    observe(tracked.frame, tracked.times, *posed);
    if (parts_.admit && !parts_.admit(batch_)) {
      ++statistics_.frames_refused;
    } else {
      integrate_samples(tracked.times);
    }
  }
  statistics_.posed.push_back(*posed);
}

std::optional<PosedFrame> ModelStage::count(const TrackedFrame& tracked) {
  ++statistics_.frames_read;
  if (const auto* rejection = std::get_if<capture::PoseRejection>(&tracked.pose)) {
    ++statistics_.pose_rejections[std::string(name_of(*rejection))];
    return std::nullopt;
  }
  const auto& pose = std::get<capture::FramePose>(tracked.pose);
  if (pose.tags > 0) statistics_.reprojection_px.push_back(pose.reprojection_px);
  return PosedFrame{tracked.frame.index, tracked.frame.time_s, pose.camera_from_board};
}

void ModelStage::observe(const capture::Frame& frame, core::StageTimes& times, PosedFrame& posed) {
  {
    const auto timing = times.measure("visibility");
    see(posed.camera_from_board * parts_.board_from_object);
  }
  if (parts_.photometric.refine_poses) {
    const auto timing = times.measure("align");
    if (const auto alignment = align(frame, posed)) {
      statistics_.refined_px.push_back(alignment->motion_px);
      see(alignment->camera_from_object);
    }
  }
  {
    const auto timing = times.measure("sample");
    core::back_project(frame.image, view_, batch_);
  }
  if (parts_.photometric.exposure) {
    const auto timing = times.measure("align");
    correct_exposure();
  }
  const auto counts = core::count_rejections(view_);
  for (std::size_t i = 0; i < counts.size(); ++i) statistics_.vertex_rejections[i] += counts[i];
}

void ModelStage::integrate_samples(core::StageTimes& times) {
  if (aligner_) aligner_->note_integrated(batch_);
  if (parts_.baseline != nullptr) {
    const auto timing = times.measure("baseline");
    parts_.baseline->integrate(batch_);
  }
  const auto timing = times.measure("fit");
  parts_.model.integrate(batch_);
  ++statistics_.frames_fitted;
}

void ModelStage::see(const Eigen::Isometry3d& camera_from_object) {
  core::project_vertices(points_, parts_.camera, camera_from_object, parts_.limits, parts_.threads,
                         view_);
  parts_.visibility->reject_occluded(parts_.camera, camera_from_object, view_);
}

PosedFrame ModelStage::refined(const capture::Frame& frame, PosedFrame posed) {
  see(posed.camera_from_board * parts_.board_from_object);
  align(frame, posed);
  return posed;
}

std::optional<core::Alignment> ModelStage::align(const capture::Frame& frame, PosedFrame& posed) {
  const auto alignment = parts_.model.with([&](const fitting::Fitter& fitter) {
    return aligner_->align(frame.image, view_, fitter.light_field(), parts_.camera,
                           posed.camera_from_board * parts_.board_from_object);
  });
  if (alignment) {
    posed.camera_from_board = alignment->camera_from_object * parts_.board_from_object.inverse();
  }
  return alignment;
}

void ModelStage::correct_exposure() {
  const auto gain = parts_.model.with(
      [&](const fitting::Fitter& fitter) { return aligner_->gain(batch_, fitter.light_field()); });
  if (!gain) return;
  statistics_.gains.push_back(*gain);
  divide_by_gain(*gain, batch_);
}

}  // namespace sheen::app
