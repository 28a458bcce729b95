// SPDX-License-Identifier: MIT
#include "app/commands/replay.h"

#include "app/commands/mesh.h"
#include "app/commands/walk_session.h"
#include "app/interrupt.h"
#include "app/preview/live_session.h"
#include "app/preview/run_preview.h"
#include "app/replay_report.h"
#include "app/state/session_states.h"
#include "app/terminal_sink.h"
#include "capture/pose/trajectory.h"
#include "capture/session/new_session.h"
#include "capture/source/paced_source.h"
#include "core/mesh/placed_ply.h"
#include "core/visibility/ray_visibility.h"
#include "evaluation/views/evaluate_views.h"
#include "fitting/model_file/model_file.h"
#include "fitting/patch_light_field.h"
#include "pipeline/light/session_light.h"
#include "pipeline/posed_views.h"
#include "pipeline/reconstruct.h"
#include "pipeline/session_readout.h"
#include "render/renderer.h"
#include "render/visibility/depth_visibility.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace sheen::app {
namespace {

using evaluation::EvaluationSummary;
using pipeline::PosedFrame;
using pipeline::Reconstruction;

/// Hidden vertices by OpenGL, with the context that it needs.
class DepthVisibility final : public core::Visibility {
 public:
  explicit DepthVisibility(const core::Mesh& mesh)
      : gl_(render::make_osmesa_context()), inner_(render::make_depth_visibility(*gl_, mesh)) {}

  void reject_occluded(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                       core::VertexView& view) override {
    inner_->reject_occluded(camera, camera_from_object, view);
  }

 private:
  std::unique_ptr<render::Context> gl_;
  std::unique_ptr<core::Visibility> inner_;
};

pipeline::VisibilityFactory visibility_factory(VisibilityMethod method) {
  switch (method) {
    case VisibilityMethod::depth:
      return [](const core::Mesh& mesh, int) { return std::make_unique<DepthVisibility>(mesh); };
    case VisibilityMethod::rays:
      return core::make_ray_visibility;
    case VisibilityMethod::automatic:
    case VisibilityMethod::raster:
      break;
  }
  return {};
}

void write_poses(const std::filesystem::path& path, const std::vector<PosedFrame>& posed) {
  std::vector<capture::Trajectory::Entry> entries;
  entries.reserve(posed.size());
  for (const PosedFrame& frame : posed) {
    entries.push_back({static_cast<double>(frame.index), frame.camera_from_board.inverse()});
  }
  capture::write_trajectory(path, entries);
}

void save(const ReplayOptions& options, const Reconstruction& fitted) {
  fitting::write_model(options.output, fitted.mesh(), fitted.light_field(), fitted.frames().seen);
  if (!options.mean_output.empty()) {
    fitting::write_model(options.mean_output, fitted.mesh(), *fitted.mean_colours(),
                         fitted.frames().seen);
  }
  if (!options.mesh_output.empty()) {
    const auto& refined = fitted.mesh_refinement();
    core::write_placed_ply(options.mesh_output, refined ? refined->mesh : fitted.object_mesh());
  }
  if (!options.poses_output.empty()) write_poses(options.poses_output, fitted.frames().posed);
}

ReplayReport describe(const ReplayOptions& options, const Reconstruction& fitted) {
  const fitting::LightField& light_field = fitted.light_field();
  const fitting::FitStatistics fit = fitted.fit_statistics();
  ReplayOptions ran = options;
  ran.reconstruction = fitted.options();  // with what was measured and chosen
  nlohmann::ordered_json settings = to_json(ran);
  settings["tolerance"] = fit.tolerance ? nlohmann::ordered_json(*fit.tolerance) : nullptr;
  ReplayReport report{.frames = fitted.frames(),
                      .timer = fitted.times(),
                      .fit = fit,
                      .is_levelled = !fitted.session().paper_light.empty(),
                      .readout_s = fitted.session().camera.intrinsics().readout_s,
                      .finish_ms = fitted.finish_cpu_ms(),
                      .representation = ran.reconstruction.representation,
                      .coefficients = light_field.coefficient_count(),
                      .model_bytes = std::filesystem::file_size(options.output),
                      .board = fitted.board_refinement(),
                      .placement = fitted.mesh_placement(),
                      .mesh = fitted.mesh_refinement(),
                      .held_out = {},
                      .held_out_mean = {},
                      .held_out_refined_poses = {},
                      .findings = fitted.findings(),
                      .coverage = {},
                      .options = std::move(settings)};
  if (const auto* const patches = fitting::as_patches(light_field)) {
    report.patches = patches->patch_count();
    report.patches_observed = static_cast<std::size_t>(
        std::count(patches->observed().begin(), patches->observed().end(), std::uint8_t{1}));
  }
  return report;
}

/// Measures views that the fit has not seen; the mean colours beside the light field where there
/// are any.
std::vector<EvaluationSummary> evaluate_held_out(const Reconstruction& fitted,
                                                 const std::vector<PosedFrame>& held_out,
                                                 const CommandContext& context) {
  const core::Mesh& mesh = fitted.object_mesh();
  const auto gl = render::make_osmesa_context();
  const auto renderer =
      render::make_renderer(*gl, fitted.mesh(), fitted.light_field(), context.threads);
  const auto mean =
      render::make_renderer(*gl, fitted.mesh(), *fitted.mean_colours(), context.threads);
  render::Renderer* const renderers[] = {renderer.get(), mean.get()};
  TerminalSink sink(context);
  int done = 0;
  return evaluation::evaluate_views(
      *gl, {fitted.session(), mesh, held_out}, renderers, [&](const evaluation::ComparedView&) {
        sink.progress({"evaluating", ++done, static_cast<int>(held_out.size())});
      });
}

/// Poses of the held-out frames, refined against the finished model.
std::vector<PosedFrame> refine_held_out(Reconstruction& fitted) {
  const std::vector<PosedFrame>& held_out = fitted.frames().held_out;
  std::vector<PosedFrame> refined;
  refined.reserve(held_out.size());
  pipeline::for_each_view(fitted.session(), &fitted.object_mesh(), held_out,
                          [&](const capture::Frame& frame, const Eigen::Isometry3d&) {
                            throw_if_interrupted();
                            refined.push_back(fitted.refined(frame, held_out[refined.size()]));
                          });
  return refined;
}

void add_held_out(const ReplayOptions& options, Reconstruction& fitted,
                  const CommandContext& context, ReplayReport& report) {
  const std::vector<PosedFrame>& held_out = fitted.frames().held_out;
  if (held_out.empty() || !options.reconstruction.share.is_whole()) return;
  auto summaries = evaluate_held_out(fitted, held_out, context);
  report.held_out = std::move(summaries[0]);
  report.held_out_mean = std::move(summaries[1]);
  if (options.reconstruction.photometric.refine_poses) {
    const auto refined = refine_held_out(fitted);
    report.held_out_refined_poses = std::move(evaluate_held_out(fitted, refined, context)[0]);
  }
}

/// What a window looks at; null without --preview.
std::unique_ptr<LiveSession> make_live_session(const ReplayOptions& options, Reconstruction& fitted,
                                               bool is_camera) {
  if (!options.preview) return nullptr;
  return std::make_unique<LiveSession>(LiveSession::Parts{
      .model = fitted.model(),
      .history = fitted.history(),
      .baseline = fitted.mean_history(),
      .mesh = fitted.mesh(),
      .camera = fitted.session().camera,
      .board_from_object = fitted.session().board_from_object,
      .limits = options.reconstruction.limits,
      .is_camera = is_camera,
      .refuse_faults = options.reconstruction.refuse_mismatches,
      .save = [&options, &fitted](const fitting::LightField& light_field) {
        fitting::write_model(options.output, fitted.mesh(), light_field, fitted.frames().seen);
        return "Saved " + options.output.filename().string();
      }});
}

pipeline::ReconstructionOptions completed(const ReplayOptions& options,
                                          const CommandContext& context) {
  pipeline::ReconstructionOptions fit = options.reconstruction;
  fit.with_mean = fit.frames.hold_out > 0 || !options.mean_output.empty();
  fit.undoable = options.preview;
  fit.threads = context.threads;
  return fit;
}

/// Where the object was seen from, once the held-out views are measured.
void add_coverage(const Reconstruction& fitted, ReplayReport& report) {
  const auto* const patches = fitting::as_patches(fitted.light_field());
  if (patches == nullptr || patches->observed().size() != fitted.mesh().normals.size()) return;
  report.coverage = evaluation::measure_coverage(fitted.mesh(), fitted.session().board_from_object,
                                                 patches->observed(), fitted.frames(),
                                                 report.held_out ? &*report.held_out : nullptr);
}

bool is_session(const std::filesystem::path& folder) {
  std::error_code no_throw;
  return std::filesystem::exists(folder / "session.json", no_throw);
}

/// A session of a video or pictures. One that cannot be completed does not stay, so that the same
/// command can be tried again with more options.
class NewSession {
 public:
  explicit NewSession(const ReplayOptions& options)
      : folder_(options.new_session.empty()
                    ? std::filesystem::path(options.output).replace_extension()
                    : options.new_session) {
    capture::write_new_session(options.session, folder_);
  }
  ~NewSession() {
    std::error_code no_throw;
    if (!is_kept_) std::filesystem::remove_all(folder_, no_throw);
  }
  NewSession(const NewSession&) = delete;
  NewSession& operator=(const NewSession&) = delete;
  NewSession(NewSession&&) = delete;
  NewSession& operator=(NewSession&&) = delete;

  void keep() { is_kept_ = true; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  bool is_kept_ = false;
};

/// What a walk was lacking: camera, board and mesh, found from its images.
WalkAnswer complete_session(const ReplayOptions& options, capture::Session& session,
                            const CommandContext& context) {
  TerminalSink sink(context);
  const pipeline::FrameChoice& frames = options.reconstruction.frames;
  WalkAnswer answer;
  session = open_walk(options.session, options.walk, frames, sink, answer);
  for (const std::string& warning : session.warnings) context.note("note: " + warning);
  pipeline::complete_readout(session, frames, sink);
  if (session.mesh.empty() && session.board) {
    const MeshAnswer mesh = add_measured_mesh(session, frames, sink, context);
    const core::CameraModel camera = session.camera;  // with what was measured of it
    session = capture::open_session(session.folder);
    session.camera = camera;
    answer.document["mesh"] = mesh.document;
    answer.text += mesh.text;
  }
  pipeline::complete_light(session, frames, sink);
  return answer;
}

void run_replay(ReplayOptions options, const CommandContext& context) {
  // Open everything that may be wrong before the long work.
  context.check_outputs({options.output, options.mean_output, options.mesh_output,
                         options.state_output, options.poses_output});
  if (options.preview) check_display();
  std::optional<NewSession> made;
  if (!is_session(options.session)) {
    made.emplace(options);
    options.session = made->folder();
  } else if (!options.new_session.empty()) {
    throw UsageError("--session-out is for a video or pictures, this is a session already");
  }
  const FitOutcome outcome = fit_recording(options, context, [&made] {
    if (made) made->keep();
  });
  context.publish(outcome.document, outcome.text);
}

}  // namespace

FitOutcome fit_recording(const ReplayOptions& options, const CommandContext& context,
                         const std::function<void()>& on_complete) {
  capture::Session session;
  const WalkAnswer walk = complete_session(options, session, context);
  if (on_complete) on_complete();
  if (!options.note.empty()) context.note(options.note);
  auto frames = capture::open_frames(session, options.reconstruction.frames.start,
                                     options.reconstruction.frames.end);
  if (options.preview) frames = capture::at_recorded_pace(std::move(frames));
  FitOutcome outcome = fit_session(options, session, std::move(frames), context);
  if (!walk.document.is_null()) outcome.document["walk"] = walk.document;
  outcome.text = walk.text + outcome.text;
  return outcome;
}

FitOutcome fit_session(const ReplayOptions& options, const capture::Session& session,
                       std::unique_ptr<capture::FrameSource> frames, const CommandContext& context,
                       const LiveCamera* camera) {
  TerminalSink sink(context);
  SessionState state(session);
  Reconstruction fitted({.session = session,
                         .frames = std::move(frames),
                         .make_visibility = visibility_factory(options.visibility),
                         .is_live = camera != nullptr,
                         .on_samples = state.listener()},
                        completed(options, context), sink);
  if (!options.state_output.empty()) {
    state.open(options.state_output, {fitted.options().representation, fitted.options().fit,
                                      fitted.mesh(), fitted.options().share});
  }
  const auto live = make_live_session(options, fitted, camera != nullptr);
  FitOutcome outcome;
  const auto work = [&] {
    fitted.run(sink, live.get());
    save(options, fitted);
    state.commit();
    if (live) live->finish();
    ReplayReport report = describe(options, fitted);
    add_held_out(options, fitted, context, report);
    add_coverage(fitted, report);
    outcome = {to_json(report), to_text(report) + "written  " + options.output.string() + "\n"};
  };
  if (!live) {
    work();
    return outcome;
  }
  run_preview({.title = options.session.filename().string() + " \u2013 Sheen",
               .mesh = fitted.mesh(),
               .up = live->up(),
               .live = live.get(),
               .snapshot_folder = options.snapshots},
              work, camera != nullptr ? camera->on_window_closed : nullptr);
  return outcome;
}

void add_replay_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<ReplayOptions>();
  Command command = program.command("replay", "Turn a recording into a light field");
  command.example(
      "Examples:\n"
      "  sheen replay walk.mp4 -o knot.glb          a walk round an object on the sheet of sheen\n"
      "                                             board: camera and mesh are found, too, and\n"
      "                                             kept in the session folder knot\n"
      "  sheen replay photos -o knot.glb --board board.yaml    on another board\n"
      "  sheen replay sample_data/glossy -o model.glb --hold-out 5    a session; keep every fifth\n"
      "                                             frame out and report the error on those");
  add_replay_options(command, *options);
  add_common_options(command, context);
  command.action([options, &context] { run_replay(*options, context); });
}

}  // namespace sheen::app
