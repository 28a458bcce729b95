// SPDX-License-Identifier: MIT
#include "app/pipeline/producer.h"

#include "core/samples/back_projection.h"

namespace sheen::app {

Producer::Producer(Parts parts)
    : parts_(std::move(parts)), tangent_frames_(core::tangent_frames(parts_.mesh)) {
  if (parts_.photometric.refine_poses || parts_.photometric.exposure)
    aligner_.emplace(parts_.mesh, parts_.photometric.pose_error_px);
}

std::optional<FrameReport> Producer::step() {
  // Close the books of this frame whatever happens to it.
  auto frame_timing = timer_.measure_frame();

  // Read the next picture.
  std::optional<capture::Frame> frame;
  {
    const auto timing = timer_.measure("decode");
    frame = parts_.frames->next();
  }
  if (!frame) {
    frame_timing.discard();
    return std::nullopt;
  }
  ++statistics_.frames_read;

  // Find the camera; fit the frame unless it is held out.
  FrameReport report;
  if (const auto pose = pose_of(*frame)) {
    PosedFrame posed{frame->index, frame->time_s, pose->camera_from_stage};
    if (parts_.hold_out.contains(frame->index)) {
      statistics_.held_out.push_back(posed);
    } else {
      observe(*frame, posed);
      report.update = fit();
      ++statistics_.frames_fitted;
    }
    statistics_.posed.push_back(posed);
  }
  report.frames_read = statistics_.frames_read;
  report.frames_posed = static_cast<int>(statistics_.posed.size());
  return report;
}

std::optional<capture::FramePose> Producer::pose_of(const capture::Frame& frame) {
  const auto timing = timer_.measure("pose");
  const capture::PoseResult result = parts_.poses->estimate(frame);
  if (const auto* rejection = std::get_if<capture::PoseRejection>(&result)) {
    ++statistics_.pose_rejections[std::string(name_of(*rejection))];
    return std::nullopt;
  }
  const auto& pose = std::get<capture::FramePose>(result);
  if (pose.tags > 0) statistics_.reprojection_px.push_back(pose.reprojection_px);
  return pose;
}

void Producer::observe(const capture::Frame& frame, PosedFrame& posed) {
  see(posed.camera_from_stage * parts_.stage_from_object);
  if (parts_.photometric.refine_poses) {
    if (const auto alignment = align(frame, posed)) {
      statistics_.refined_px.push_back(alignment->motion_px);
      see(alignment->camera_from_object);
    }
  }
  {
    const auto timing = timer_.measure("sample");
    core::back_project(frame.image, view_, batch_);
  }
  if (parts_.photometric.exposure) correct_exposure();
  if (aligner_) aligner_->note_absorbed(batch_);
  const auto counts = core::count_rejections(view_);
  for (std::size_t i = 0; i < counts.size(); ++i) statistics_.vertex_rejections[i] += counts[i];
  if (parts_.baseline != nullptr) {
    const auto timing = timer_.measure("baseline");
    parts_.baseline->absorb(batch_);
  }
}

void Producer::see(const Eigen::Isometry3d& camera_from_object) {
  const auto timing = timer_.measure("visibility");
  core::project_vertices(parts_.mesh, tangent_frames_, parts_.camera, camera_from_object,
                         parts_.limits, parts_.threads, view_);
  parts_.visibility->reject_occluded(parts_.camera, camera_from_object, view_);
}

PosedFrame Producer::refined(const capture::Frame& frame, PosedFrame posed) {
  see(posed.camera_from_stage * parts_.stage_from_object);
  align(frame, posed);
  return posed;
}

std::optional<core::Alignment> Producer::align(const capture::Frame& frame, PosedFrame& posed) {
  const auto timing = timer_.measure("align");
  const auto alignment =
      aligner_->align(frame.image, view_, parts_.representation.light_field(), parts_.camera,
                      posed.camera_from_stage * parts_.stage_from_object);
  if (alignment) {
    posed.camera_from_stage = alignment->camera_from_object * parts_.stage_from_object.inverse();
  }
  return alignment;
}

void Producer::correct_exposure() {
  const auto timing = timer_.measure("align");
  const auto gain = aligner_->gain(batch_, parts_.representation.light_field());
  if (!gain) return;
  statistics_.gains.push_back(*gain);
  divide_by_gain(*gain, batch_);
}

fitting::ModelUpdate Producer::fit() {
  const fitting::ModelUpdate* update = nullptr;
  {
    const auto timing = timer_.measure("fit");
    update = &parts_.representation.absorb(batch_);
  }
  // The watcher reads its copy while the next frame is fitted.
  const auto timing = timer_.measure("update");
  return *update;
}

}  // namespace sheen::app
