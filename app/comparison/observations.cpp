// SPDX-License-Identifier: MIT
#include "app/comparison/observations.h"

#include "app/pipeline/check_seen.h"
#include "app/pipeline/pipeline.h"
#include "core/diagnostics/error.h"
#include "core/visibility/raster_visibility.h"
#include "fitting/registry.h"

#include <utility>

namespace sheen::app {
namespace {

/// Keeps every batch that passes through to a plain representation, so that the pipeline of
/// `sheen replay` makes the observations here, too.
class SampleRecorder final : public fitting::Fitter {
 public:
  explicit SampleRecorder(const core::VertexNeighbours& neighbours)
      : inner_(fitting::make_fitter("mean", neighbours, {})) {}

  const fitting::ModelUpdate& integrate(const core::SampleBatch& batch) override {
    batches_.push_back(batch);
    return inner_->integrate(batch);
  }
  const fitting::ModelUpdate& finish() override { return inner_->finish(); }
  [[nodiscard]] const fitting::LightField& light_field() const override {
    return inner_->light_field();
  }
  [[nodiscard]] fitting::FitStatistics statistics() const override { return inner_->statistics(); }

  std::vector<core::SampleBatch> take_batches() { return std::move(batches_); }

 private:
  std::unique_ptr<fitting::Fitter> inner_;
  std::vector<core::SampleBatch> batches_;
};

void hold_out_own_views(const std::filesystem::path& folder, Observations& observations) {
  SessionOptions options;
  options.folder = folder;
  observations.held_out_session = capture::open_session(folder);
  observations.held_out = pose_frames(observations.held_out_session, options, [](int) {});
}

void check_views_are_held_out(const Observations& observations) {
  if (!observations.held_out.empty()) return;
  throw core::bad_input(observations.held_out_session.folder,
                        "has no posed view that is held out of the fit",
                        "use a smaller --hold-out, 2 or more, or give the session a held_out/ "
                        "folder with posed views");
}

}  // namespace

Observations observe_session(const SessionOptions& options, int threads,
                             const std::function<void(int frames_read)>& on_frame) {
  // Open what may be wrong.
  Observations observations;
  observations.session = capture::open_session(options.folder);
  observations.mesh = read_object_mesh(observations.session.mesh);
  observations.neighbours = core::vertex_neighbours(observations.mesh);
  const auto own_views = options.folder / "held_out";
  observations.has_own_held_out = std::filesystem::exists(own_views / "session.json");

  // Pose, see and sample.
  const capture::Session& session = observations.session;
  SampleRecorder recorder(observations.neighbours);
  PoseStage poses(capture::open_frames(session, options.start, options.end),
                  make_pose_estimator(session, options.pose_source, options.gate));
  SharedModel model(recorder);
  ModelStage stage({.visibility = core::make_raster_visibility(observations.mesh, threads),
                    .mesh = observations.mesh,
                    .camera = session.camera,
                    .board_from_object = session.board_from_object,
                    .limits = {},
                    .model = model,
                    .baseline = nullptr,
                    .hold_out = {observations.has_own_held_out ? 0 : options.hold_out},
                    .threads = threads});
  run_pipeline(poses, stage, threads > 1,
               [&](const TrackedFrame&) { on_frame(stage.statistics().frames_read); });
  check_something_was_seen(session, stage.statistics(), recorder.statistics().samples);
  observations.views = recorder.take_batches();

  // Set the views aside on which candidates are measured.
  if (observations.has_own_held_out) {
    hold_out_own_views(own_views, observations);
  } else {
    observations.held_out_session = session;
    observations.held_out = stage.statistics().held_out;
  }
  check_views_are_held_out(observations);
  return observations;
}

}  // namespace sheen::app
