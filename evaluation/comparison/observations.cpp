// SPDX-License-Identifier: MIT
#include "evaluation/comparison/observations.h"

#include "core/diagnostics/error.h"
#include "core/visibility/raster_visibility.h"
#include "pipeline/check_seen.h"
#include "pipeline/evidence/capture_evidence.h"
#include "pipeline/frame_loop.h"
#include "pipeline/hold_out.h"
#include "pipeline/light/session_light.h"
#include "pipeline/mesh_heights.h"
#include "pipeline/mesh_placement.h"
#include "pipeline/mesh_stills.h"
#include "pipeline/observation_replay.h"
#include "pipeline/pose_frames.h"
#include "pipeline/session_mesh.h"
#include "pipeline/session_parts.h"
#include "pipeline/session_readout.h"

#include <optional>
#include <utility>

namespace sheen::evaluation {
namespace {

pipeline::ViewObserver make_observer(const core::Mesh& mesh, int threads) {
  return {mesh, core::make_raster_visibility(mesh, threads), {}, threads};
}

/// Puts the mesh and its vertices right where its print confirms it, by the frames that are fitted.
std::optional<pipeline::MeshPlacement> refine(pipeline::FrameChoice choice, int threads,
                                              pipeline::ProgressSink& sink,
                                              Observations& observations) {
  if (observations.has_own_held_out) choice.hold_out = 0;
  const capture::Session& session = observations.session;
  pipeline::PoseStage stills(
      capture::open_frames(session, choice.start, choice.end),
      pipeline::make_pose_estimator(session, choice.pose_source, choice.gate),
      pipeline::FrameCorrections(session, &observations.mesh, threads));
  const auto images = pipeline::read_stills(session, choice, stills, sink);
  const auto board = pipeline::tag_board(session, choice.pose_source);
  if (!pipeline::are_poses_sound(session, board, images, sink)) return std::nullopt;
  auto placement = pipeline::place_mesh(observations.mesh, images, threads, sink);
  if (placement) observations.mesh = placement->mesh;
  observations.mesh =
      pipeline::refine_mesh_heights(observations.mesh, images, fitting::heights::Outlines::may_move,
                                    threads, sink)
          .mesh;
  return placement;
}

/// Poses and samples every frame that is not held out; those that are go to the observations, too.
void observe_frames(const pipeline::FrameChoice& choice,
                    const std::optional<pipeline::MeshPlacement>& placement, int threads,
                    pipeline::ProgressSink& sink, Observations& observations) {
  const capture::Session& session = observations.session;
  const pipeline::HoldOut hold_out{observations.has_own_held_out ? 0 : choice.hold_out};
  pipeline::PoseStage poses(capture::open_frames(session, choice.start, choice.end),
                            pipeline::make_pose_estimator(session, choice.pose_source, choice.gate),
                            pipeline::FrameCorrections(session, &observations.mesh, threads));
  pipeline::ViewObserver observer = make_observer(observations.mesh, threads);
  pipeline::FrameStatistics frames;
  std::size_t samples = 0;
  pipeline::SessionScene scene(session, observations.mesh, choice.pose_source, sink);
  pipeline::CaptureEvidence evidence(session, observations.mesh, observations.mesh,
                                     pipeline::tag_board(session, choice.pose_source));
  if (placement) evidence.note(placement->finding(pipeline::kIsPutRight));
  pipeline::for_each_frame(poses, threads > 1, [&](pipeline::TrackedFrame& tracked) {
    const auto posed = frames.count(tracked);
    sink.progress({"observing", frames.frames_read});
    if (!posed) return;
    frames.posed.push_back(*posed);
    scene.see(posed->camera_from_board);
    if (hold_out.contains(posed->index)) {
      observations.held_out.push_back(*posed);
      return;
    }
    const auto camera_from_object = posed->camera_from_board * session.board_from_object;
    const auto observation = observer.observe(posed->index, tracked.frame.image,
                                              session.camera_of(posed->index), camera_from_object);
    evidence.look_at(tracked.frame, posed->camera_from_board, observation);
    observations.views.push_back({posed->index, camera_from_object, 1, *posed});
    observations.samples.push_back(observation.samples);
    samples += observation.samples.size();
  });
  scene.finish(sink);
  const capture::SourceReport recording = poses.report();
  for (const std::string& note : recording.notes) sink.note(note);
  pipeline::check_something_was_seen(session, choice, frames, samples, scene);
  for (const pipeline::Finding& finding : evidence.findings()) sink.note(finding.line);
}

void check_views_are_held_out(const Observations& observations) {
  if (!observations.held_out.empty()) return;
  throw core::bad_input(observations.held_out_session.folder,
                        "has no posed view that is held out of the fit",
                        "use a smaller --hold-out, 2 or more, or give the session a held_out/ "
                        "folder with posed views");
}

}  // namespace

Observations observe_session(const std::filesystem::path& folder,
                             const pipeline::FrameChoice& choice, bool refine_mesh, int threads,
                             pipeline::ProgressSink& sink) {
  Observations observations;
  observations.session = capture::open_session(folder);
  pipeline::complete_readout(observations.session, choice, sink);
  pipeline::complete_light(observations.session, choice, sink);
  observations.mesh = pipeline::read_session_mesh(observations.session, sink);
  pipeline::face_cameras(observations.mesh, observations.session,
                         pipeline::probe_poses(observations.session, choice), sink);
  const auto own_views = folder / "held_out";
  observations.has_own_held_out = std::filesystem::exists(own_views / "session.json");
  std::optional<pipeline::MeshPlacement> placement;
  if (refine_mesh) placement = refine(choice, threads, sink, observations);
  observe_frames(choice, placement, threads, sink, observations);
  observations.held_out_session = observations.session;
  if (observations.has_own_held_out) {
    observations.held_out_session = capture::open_session(own_views);
    observations.held_out_session.take_offset(observations.mesh.offset);
    observations.held_out = pipeline::pose_frames(observations.held_out_session, {}, sink);
  }
  check_views_are_held_out(observations);
  return observations;
}

void integrate_all(const Observations& observations, int threads, fitting::Fitter& fitter,
                   pipeline::ProgressSink& sink) {
  int done = 0;
  const auto integrate = [&](const core::Observation& observation) {
    fitter.integrate(observation);
    sink.progress({"fitting", ++done, static_cast<int>(observations.views.size())});
  };
  if (fitter.needs_images()) {
    pipeline::ViewObserver observer = make_observer(observations.mesh, threads);
    std::optional<capture::DepthImages> depth;
    if (observations.session.depth && fitter.needs_depth()) depth.emplace(observations.session);
    pipeline::replay_observations(observations.session, observations.mesh, observations.views,
                                  observer, depth ? &*depth : nullptr, integrate);
    return;
  }
  const cv::Mat no_image;
  const core::VertexView no_view;
  for (std::size_t i = 0; i < observations.views.size(); ++i) {
    const pipeline::IntegratedView& view = observations.views[i];
    integrate({view.frame_index, no_image, observations.session.camera_of(view.frame_index),
               view.camera_from_object, no_view, observations.samples[i]});
  }
}

}  // namespace sheen::evaluation
