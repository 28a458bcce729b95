// SPDX-License-Identifier: MIT
#include "app/commands/replay.h"

#include "app/evaluation/evaluate_views.h"
#include "app/evaluation/posed_views.h"
#include "app/pipeline/check_seen.h"
#include "app/pipeline/model_stage.h"
#include "app/pipeline/patch_mesh.h"
#include "app/pipeline/pipeline.h"
#include "app/pipeline/pose_stage.h"
#include "app/pipeline/replay_report.h"
#include "app/pipeline/session_board.h"
#include "app/preview/run_preview.h"
#include "capture/pose/trajectory.h"
#include "capture/source/paced_source.h"
#include "core/diagnostics/cpu_clock.h"
#include "core/diagnostics/error.h"
#include "core/mesh/neighbours.h"
#include "core/visibility/raster_visibility.h"
#include "core/visibility/ray_visibility.h"
#include "fitting/model_file/model_file.h"
#include "fitting/registry.h"
#include "render/visibility/depth_visibility.h"

#include <fmt/format.h>

namespace sheen::app {
namespace {

/// What a replay builds from the same samples: the light field and, to compare with, mean colours.
struct LightFields {
  std::unique_ptr<fitting::Fitter> fitted;
  /// Null when nobody asks for mean colours, or `fitted` is the mean itself.
  std::unique_ptr<fitting::Fitter> mean;
  /// The same two where views may be taken back; else null.
  fitting::UndoableFitter* fitted_history = nullptr;
  fitting::UndoableFitter* mean_history = nullptr;

  LightFields(const ReplayOptions& options, const core::Mesh& mesh, int threads) {
    const auto neighbours = core::vertex_neighbours(mesh);
    const fitting::FitOptions fit_options{
        .iwls = options.iwls, .threads = threads, .sparse = options.sparse};
    const auto make = [&](const std::string& name,
                          fitting::UndoableFitter*& history) -> std::unique_ptr<fitting::Fitter> {
      if (!options.preview) return fitting::make_fitter(name, neighbours, fit_options);
      auto undoable = std::make_unique<fitting::UndoableFitter>(
          [=] { return fitting::make_fitter(name, neighbours, fit_options); });
      history = undoable.get();
      return undoable;
    };
    fitted = make(options.registered_name(), fitted_history);
    const bool is_asked_for = options.session.hold_out > 0 || !options.mean_output.empty();
    if (is_asked_for && options.registered_name() != "mean") mean = make("mean", mean_history);
  }

  [[nodiscard]] const fitting::LightField& mean_colours() const {
    return mean ? mean->light_field() : fitted->light_field();
  }

  /// Finishes the fitted one through `model`, which guards it; returns the CPU time of that.
  [[nodiscard]] double finish(SharedModel& model) {
    const double start_ms = core::own_cpu_ms();
    model.finish();
    const double elapsed_ms = core::own_cpu_ms() - start_ms;
    if (mean) mean->finish();
    return elapsed_ms;
  }
};

/// `live` may be null.
core::StageTimer fit_frames(PoseStage& poses, ModelStage& stage, std::optional<int> frame_count,
                            const CommandContext& context, LiveSession* live) {
  Progress progress = context.progress("fitting", frame_count.value_or(0));
  const FrameStatistics& frames = stage.statistics();
  return run_pipeline(poses, stage, context.threads > 1, [&](const TrackedFrame& tracked) {
    progress.show(frames.frames_read, fmt::format("{} posed", frames.posed.size()));
    if (live != nullptr) live->on_frame(tracked, frames);
  });
}

void write_poses(const std::filesystem::path& path, const std::vector<PosedFrame>& posed) {
  std::vector<capture::Trajectory::Entry> entries;
  entries.reserve(posed.size());
  for (const PosedFrame& frame : posed) {
    entries.push_back({static_cast<double>(frame.index), frame.camera_from_board.inverse()});
  }
  capture::write_trajectory(path, entries);
}

std::vector<EvaluationSummary> evaluate_held_out(const capture::Session& session,
                                                 const core::Mesh& mesh, const LightFields& fields,
                                                 const std::vector<PosedFrame>& held_out,
                                                 const CommandContext& context) {
  const auto gl = render::make_osmesa_context();
  const auto fitted = render::make_gl_surface_renderer(*gl, mesh, fields.fitted->light_field());
  const auto mean = render::make_gl_surface_renderer(*gl, mesh, fields.mean_colours());
  render::SurfaceRenderer* const renderers[] = {fitted.get(), mean.get()};
  Progress progress = context.progress("evaluating", static_cast<int>(held_out.size()));
  int done = 0;
  return evaluate_views(session, held_out, renderers,
                        [&](const ComparedView&) { progress.show(++done); });
}

/// Poses of the held-out frames, refined against the finished model.
std::vector<PosedFrame> refine_held_out(const capture::Session& session, ModelStage& stage) {
  const std::vector<PosedFrame>& held_out = stage.statistics().held_out;
  std::vector<PosedFrame> refined;
  refined.reserve(held_out.size());
  for_each_view(session, held_out, [&](const capture::Frame& frame, const Eigen::Isometry3d&) {
    refined.push_back(stage.refined(frame, held_out[refined.size()]));
  });
  return refined;
}

/// Refines the board where it is asked for and the poses come from its tags.
std::optional<capture::BoardRefinement> refine_board(const capture::Session& session,
                                                     const ReplayOptions& options,
                                                     const CommandContext& context) {
  if (!options.refine_board) return std::nullopt;
  if (takes_poses_from_file(session, options.session.pose_source)) {
    context.note("note: the poses come from a file, --refine-board changes nothing");
    return std::nullopt;
  }
  Progress progress = context.progress("refining board", 0);
  auto refinement = refine_session_board(session, options.session.start, options.session.end,
                                         [&](int frames_read) { progress.show(frames_read); });
  if (!refinement) context.note("note: too few tags are seen together to refine the board");
  return refinement;
}

/// The session's mesh, refined to the images' resolution when patches are texels.
core::Mesh read_patch_mesh(const capture::Session& session, const ReplayOptions& options,
                           const capture::Board* board) {
  core::Mesh mesh = read_object_mesh(session.mesh);
  if (options.patches == "vertex") return mesh;
  const auto poses =
      make_pose_estimator(session, options.session.pose_source, options.session.gate, board);
  const auto footprint_m = pixel_footprint_m(session, mesh, *poses);
  if (!footprint_m) return mesh;  // the replay itself will say why no frame is posed
  return texel_mesh(mesh, *footprint_m, options.texel_px);
}

/// Finds hidden vertices the way that was asked for; owns what that way needs.
struct ChosenVisibility {
  std::unique_ptr<render::Context> gl;
  std::unique_ptr<core::Visibility> method;

  ChosenVisibility(VisibilityMethod choice, const core::Mesh& mesh, int threads) {
    if (choice == VisibilityMethod::depth) {
      gl = render::make_osmesa_context();
      method = render::make_depth_visibility(*gl, mesh);
    } else if (choice == VisibilityMethod::rays) {
      method = core::make_ray_visibility(mesh, threads);
    } else {
      method = core::make_raster_visibility(mesh, threads);
    }
  }
};

void save(const ReplayOptions& options, const core::Mesh& mesh, const LightFields& fields,
          const std::vector<PosedFrame>& posed) {
  fitting::write_model(options.output, mesh, fields.fitted->light_field());
  if (!options.mean_output.empty()) {
    fitting::write_model(options.mean_output, mesh, fields.mean_colours());
  }
  if (!options.poses_output.empty()) write_poses(options.poses_output, posed);
}

ReplayReport describe(const ReplayOptions& options, const LightFields& fields,
                      const FrameStatistics& frames, const core::StageTimer& timer) {
  const fitting::LightField& light_field = fields.fitted->light_field();
  const auto& observed = light_field.observed();
  const fitting::FitStatistics fit = fields.fitted->statistics();
  nlohmann::ordered_json settings = to_json(options);
  settings["tolerance"] = fit.tolerance ? nlohmann::ordered_json(*fit.tolerance) : nullptr;
  return {.frames = frames,
          .timer = timer,
          .fit = fit,
          .representation = options.registered_name(),
          .patches = light_field.patch_count(),
          .patches_observed = static_cast<std::size_t>(
              std::count(observed.begin(), observed.end(), std::uint8_t{1})),
          .coefficients = light_field.coefficient_count(),
          .model_bytes = std::filesystem::file_size(options.output),
          .board = {},
          .held_out = {},
          .held_out_mean = {},
          .held_out_refined_poses = {},
          .options = std::move(settings)};
}

/// Measures on the views that the fit has not seen.
void add_held_out(const ReplayOptions& options, const capture::Session& session,
                  const core::Mesh& mesh, const LightFields& fields, ModelStage& stage,
                  const CommandContext& context, ReplayReport& report) {
  const std::vector<PosedFrame>& held_out = stage.statistics().held_out;
  if (held_out.empty()) return;
  auto summaries = evaluate_held_out(session, mesh, fields, held_out, context);
  report.held_out = std::move(summaries[0]);
  report.held_out_mean = std::move(summaries[1]);
  if (options.photometric.refine_poses) {
    const auto refined = refine_held_out(session, stage);
    report.held_out_refined_poses =
        std::move(evaluate_held_out(session, mesh, fields, refined, context)[0]);
  }
}

/// What a window looks at; null without --preview.
std::unique_ptr<LiveSession> make_live_session(const ReplayOptions& options,
                                               const capture::Session& session,
                                               const core::Mesh& mesh, const LightFields& fields,
                                               SharedModel& model, bool is_camera) {
  if (!options.preview) return nullptr;
  return std::make_unique<LiveSession>(
      LiveSession::Parts{.model = model,
                         .history = *fields.fitted_history,
                         .baseline = fields.mean_history,
                         .mesh = mesh,
                         .camera = session.camera,
                         .board_from_object = session.board_from_object,
                         .limits = options.limits,
                         .is_camera = is_camera,
                         .refuse_faults = options.refuse_mismatches,
                         .save = [&](const fitting::LightField& light_field) {
                           fitting::write_model(options.output, mesh, light_field);
                           return "Saved " + options.output.filename().string();
                         }});
}

/// Who decides whether samples are taken in; nobody when all of them are.
std::function<bool(const core::SampleBatch&)> admission(const ReplayOptions& options,
                                                        SharedModel& model, LiveSession* live) {
  if (live != nullptr) return [live](const core::SampleBatch& batch) { return live->admit(batch); };
  if (!options.refuse_mismatches) return {};
  const auto patches =
      model.with([](const fitting::Fitter& r) { return r.light_field().patch_count(); });
  const auto score = std::make_shared<fitting::guidance::CaptureScore>(patches);
  return [&model, score](const core::SampleBatch& batch) {
    const auto verdict = model.with(
        [&](const fitting::Fitter& fitter) { return score->judge(batch, fitter.light_field()); });
    if (verdict != fitting::guidance::FrameVerdict::fine) return false;
    score->note(batch, 0);
    return true;
  };
}

void run_replay(const ReplayOptions& options, const CommandContext& context) {
  // Open everything that may be wrong before the long work.
  context.check_outputs({options.output, options.mean_output, options.poses_output});
  const capture::Session session = capture::open_session(options.session.folder);
  for (const std::string& warning : session.warnings) context.note("note: " + warning);
  auto frames = capture::open_frames(session, options.session.start, options.session.end);
  if (options.preview) frames = capture::at_recorded_pace(std::move(frames));
  const auto refinement = refine_board(session, options, context);

  const FitOutcome outcome = fit_session(options, session, refinement, std::move(frames), context);
  context.publish(outcome.document, outcome.text);
}

}  // namespace

FitOutcome fit_session(const ReplayOptions& options, const capture::Session& session,
                       const std::optional<capture::BoardRefinement>& refinement,
                       std::unique_ptr<capture::FrameSource> frames, const CommandContext& context,
                       const LiveCamera* camera) {
  const capture::Board* const board = refinement ? &refinement->board : nullptr;
  const core::Mesh mesh = read_patch_mesh(session, options, board);
  const std::optional<int> frame_count = frames->frame_count();
  ChosenVisibility visibility(options.visibility, mesh, context.threads);

  // Fit frame by frame, watched or not.
  LightFields fields(options, mesh, context.threads);
  SharedModel model(*fields.fitted);
  const auto live = make_live_session(options, session, mesh, fields, model, camera != nullptr);
  PoseStage poses(std::move(frames), make_pose_estimator(session, options.session.pose_source,
                                                         options.session.gate, board));
  ModelStage stage({.visibility = std::move(visibility.method),
                    .mesh = mesh,
                    .camera = session.camera,
                    .board_from_object = session.board_from_object,
                    .limits = options.limits,
                    .model = model,
                    .baseline = fields.mean.get(),
                    .hold_out = {options.session.hold_out},
                    .photometric = options.photometric,
                    .threads = context.threads,
                    .admit = admission(options, model, live.get())});
  FitOutcome outcome;
  const auto work = [&] {
    const core::StageTimer timer = fit_frames(poses, stage, frame_count, context, live.get());
    check_something_was_seen(session, stage.statistics(), fields.fitted->statistics().samples);
    const double finish_ms = fields.finish(model);

    // Save, measure and report.
    save(options, mesh, fields, stage.statistics().posed);
    if (live) live->finish();
    ReplayReport report = describe(options, fields, stage.statistics(), timer);
    report.board = refinement;
    report.finish_ms = finish_ms;
    add_held_out(options, session, mesh, fields, stage, context, report);
    outcome = {to_json(report), to_text(report) + "written  " + options.output.string() + "\n"};
  };
  if (!live) {
    work();
    return outcome;
  }
  run_preview({.title = options.session.folder.filename().string() + " \u2013 Sheen",
               .mesh = mesh,
               .up = live->up(),
               .live = live.get(),
               .snapshot_folder = options.snapshots},
              work, camera != nullptr ? camera->on_window_closed : nullptr);
  return outcome;
}

void add_replay_command(CLI::App& program, CommandContext& context) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command =
      program.add_subcommand("replay", "Turn a recorded session into a light field");
  command->footer(
      "Example: fit a session, keep every fifth frame out and report the error on those:\n"
      "  sheen replay sample_data/glossy -o model.glb --hold-out 5");
  add_replay_options(*command, *options);
  add_common_options(*command, context);
  command->callback([options, &context] { run_replay(*options, context); });
}

}  // namespace sheen::app
