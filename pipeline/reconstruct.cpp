// SPDX-License-Identifier: MIT
#include "pipeline/reconstruct.h"

#include "core/diagnostics/cpu_clock.h"
#include "core/diagnostics/error.h"
#include "core/mesh/bounds.h"
#include "core/visibility/raster_visibility.h"
#include "fitting/descriptor.h"
#include "fitting/guidance/capture_score.h"
#include "pipeline/check_seen.h"
#include "pipeline/evidence/capture_evidence.h"
#include "pipeline/frame_loop.h"
#include "pipeline/mesh_stills.h"
#include "pipeline/observation_replay.h"
#include "pipeline/patch_mesh.h"
#include "pipeline/session_board.h"
#include "pipeline/session_mesh.h"
#include "pipeline/session_parts.h"
#include "pipeline/texel_size.h"
#include "pipeline/thinned.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace sheen::pipeline {
namespace {

constexpr const char* kMean = "mean";
constexpr const char* kVertexPatches = "sparse";
constexpr const char* kTextured = "detail";
constexpr std::size_t kMostLiveStills = 40;        // of which half remain at times
constexpr std::size_t kFewestMeasuringViews = 20;  // of fewer, gloss may pass for a height

/// For work that nobody asked for: how far it has come, and nothing of what it leaves undone.
class WithoutNotes : public ProgressSink {
 public:
  explicit WithoutNotes(ProgressSink& sink) : sink_(sink) {}
  void progress(const StepProgress& step) override { sink_.progress(step); }

 private:
  ProgressSink& sink_;
};

/// Refines the board where it is asked for and the poses come from its tags.
std::optional<capture::BoardRefinement> refine_board(const capture::Session& session,
                                                     const ReconstructionOptions& options,
                                                     ProgressSink& sink) {
  if (!options.refine_board) return std::nullopt;
  if (takes_poses_from_file(session, options.frames.pose_source)) {
    sink.note("the poses come from a file, --refine-board changes nothing");
    return std::nullopt;
  }
  auto refinement = refine_session_board(session, options.frames.start, options.frames.end, sink);
  if (!refinement) sink.note("too few tags are seen together to refine the board");
  return refinement;
}

std::unique_ptr<core::Visibility> make_visibility(const VisibilityFactory& factory,
                                                  const core::Mesh& mesh, int threads) {
  return factory ? factory(mesh, threads) : core::make_raster_visibility(mesh, threads);
}

}  // namespace

struct Reconstruction::Impl {
  Impl(ReconstructionInputs inputs, const ReconstructionOptions& wanted, ProgressSink& sink);

  core::Mesh read_mesh(ProgressSink& sink);
  [[nodiscard]] bool may_measure_mesh() const;
  void look_at_place(const TrackedFrame& tracked);
  void tell_place(ProgressSink& sink);
  bool may_refine_mesh();
  void measure_mesh(ProgressSink& sink);
  core::Mesh patch_mesh();
  void look_at_sides(const TrackedFrame& tracked, ProgressSink& sink);
  double texel_size_m(const core::Mesh& surface) const;
  void choose_texels();
  std::unique_ptr<capture::PoseEstimator> pose_estimator() const;
  [[nodiscard]] std::optional<capture::Board> pose_board() const;
  std::unique_ptr<fitting::Fitter> make_fitter(const std::string& name,
                                               const fitting::OptionValues& values,
                                               fitting::UndoableFitter*& history);
  bool admit(const core::SampleBatch& batch, FrameListener* listener);
  void tell_new(const std::vector<Finding>& found, ProgressSink& sink);
  void tell_early(ProgressSink& sink);
  void finish();

  ReconstructionOptions options;
  capture::Session session;
  bool is_live = false;
  std::optional<capture::BoardRefinement> board;
  core::Mesh object_mesh;
  SessionScene scene;
  std::optional<double> texel_m;  ///< for the mesh as given, where that was asked for
  std::optional<MeshPlacement> placement;
  std::optional<MeshRefinement> refinement;
  core::Mesh mesh;
  std::vector<Eigen::Isometry3d> first_poses;  ///< of a live recording: which side do they see
  Thinned<PosedImage> live_stills;             ///< of it: is the mesh at its place
  std::unique_ptr<ViewObserver> observer;
  VisibilityFactory visibility;
  std::unique_ptr<fitting::Fitter> fitter;
  std::unique_ptr<fitting::Fitter> mean;
  fitting::UndoableFitter* history = nullptr;
  fitting::UndoableFitter* mean_history = nullptr;
  std::unique_ptr<SharedModel> model;
  std::optional<fitting::guidance::CaptureScore> score;  ///< where mismatches are refused
  std::optional<PoseStage> poses;
  std::optional<int> frame_count;
  std::optional<CaptureEvidence> evidence;
  std::vector<Finding> findings;
  int next_told = 64;  ///< frames after which a live recording is judged; doubles
  std::optional<capture::DepthImages> depth;  ///< where the session has some and they are wanted
  std::optional<FitStage> stage;
  FrameListener* listener = nullptr;
  core::StageTimer times;
  double finish_cpu_ms = 0;
};

Reconstruction::Impl::Impl(ReconstructionInputs inputs, const ReconstructionOptions& wanted,
                           ProgressSink& sink)
    : options(wanted),
      session(std::move(inputs.session)),
      is_live(inputs.is_live),
      board(refine_board(session, options, sink)),
      object_mesh(read_mesh(sink)),
      scene(session, object_mesh, options.frames.pose_source, sink),
      live_stills(std::min(kMostLiveStills, most_stills(session.camera))),
      visibility(inputs.make_visibility) {
  if (!is_live && may_measure_mesh()) measure_mesh(sink);
  mesh = patch_mesh();
  observer = std::make_unique<ViewObserver>(
      mesh, make_visibility(visibility, mesh, options.threads), options.limits, options.threads);
  if (asks_texel_size(options.representation, options.fit)) {
    choose_texels();
  }
  fitter = make_fitter(options.representation, options.fit, history);
  if (session.depth && fitter->needs_depth()) depth.emplace(session);
  if (options.with_mean && options.representation != kMean) {
    mean = make_fitter(kMean, {}, mean_history);
  }
  model = std::make_unique<SharedModel>(*fitter);
  if (options.refuse_mismatches) {
    const auto& patches = fitting::require_patches(fitter->light_field(), "--refuse-mismatches");
    score.emplace(patches.patch_count());
  }
  auto frames = inputs.frames
                    ? std::move(inputs.frames)
                    : capture::open_frames(session, options.frames.start, options.frames.end);
  frame_count = frames->frame_count();
  if (!is_live) check_stamps(session, options.frames, frame_count);
  poses.emplace(std::move(frames), pose_estimator(),
                FrameCorrections(session, &object_mesh, options.threads));
  evidence.emplace(session, object_mesh, mesh, pose_board());
  if (placement) evidence->note(placement->finding(kIsPutRight));
  stage.emplace(FitStage::Parts{
      .session = session,
      .mesh = mesh,
      .observer = *observer,
      .model = *model,
      .mean = mean.get(),
      .evidence = *evidence,
      .hold_out = {options.frames.hold_out},
      .depth = depth ? &*depth : nullptr,
      .photometric = options.photometric,
      .share = options.share,
      .admit = [this](const core::SampleBatch& batch) { return admit(batch, listener); },
      .on_samples = std::move(inputs.on_samples)});
}

std::unique_ptr<capture::PoseEstimator> Reconstruction::Impl::pose_estimator() const {
  return make_pose_estimator(session, options.frames.pose_source, options.frames.gate,
                             board ? &board->board : nullptr);
}

/// Of the tags that give the poses, if they do.
std::optional<capture::Board> Reconstruction::Impl::pose_board() const {
  return board ? board->board : tag_board(session, options.frames.pose_source);
}

/// The session's mesh, its outside towards the cameras.
core::Mesh Reconstruction::Impl::read_mesh(ProgressSink& sink) {
  core::Mesh read = read_session_mesh(session, sink);
  if (!is_live && needs_cameras(read)) {
    face_cameras(read, session, probe_poses(session, options.frames), sink);
  }
  return read;
}

/// Where nobody said: only where a texture would be misplaced on it.
bool Reconstruction::Impl::may_measure_mesh() const {
  if (options.refine_mesh) return *options.refine_mesh;
  return options.representation == kTextured &&
         (options.patches == Patches::automatic || options.patches == Patches::detail);
}

/// Where nobody said: only where print between the vertices could show that they lie wrong.
bool Reconstruction::Impl::may_refine_mesh() {
  constexpr double coarse = 4;  // texels for each vertex; a coarse mesh has 10 to 30, temple 3
  if (options.refine_mesh) return true;
  texel_m = texel_size_m(object_mesh);
  return texels_per_vertex(*texel_m, object_mesh) >= coarse;
}

/// Reads the recording once for it, before the run: is the mesh as large as the object and at its
/// place, and do its vertices lie on it?
void Reconstruction::Impl::measure_mesh(ProgressSink& sink) {
  PoseStage stills(capture::open_frames(session, options.frames.start, options.frames.end),
                   pose_estimator(), FrameCorrections(session, &object_mesh, options.threads));
  const auto images = read_stills(session, options.frames, stills, sink);
  const bool is_asked = options.refine_mesh.has_value();
  WithoutNotes unasked(sink);
  ProgressSink& notes = is_asked ? sink : unasked;
  if (!is_asked && images.size() < kFewestMeasuringViews) return;
  if (!are_poses_sound(session, pose_board(), images, notes)) return;
  placement = place_mesh(object_mesh, images, options.threads, sink);
  if (placement) object_mesh = placement->mesh;
  if (!may_refine_mesh()) return;
  refinement = refine_mesh_heights(object_mesh, images, fitting::heights::Outlines::may_move,
                                   options.threads, notes);
}

/// Subdivided to the images' resolution when patches are texels.
core::Mesh Reconstruction::Impl::patch_mesh() {
  const core::Mesh& surface = refinement ? refinement->mesh : object_mesh;
  if (options.patches != Patches::texel) return surface;
  const auto footprint_m = pixel_footprint_m(session, surface, *pose_estimator());
  if (!footprint_m) return surface;  // the run itself will say why no frame is posed
  return texel_mesh(surface, *footprint_m, options.texel_px);
}

/// While a recording is made its mesh is fitted already; that it is inside out can be said only.
void Reconstruction::Impl::look_at_sides(const TrackedFrame& tracked, ProgressSink& sink) {
  constexpr std::size_t enough = 20;
  const auto* pose = std::get_if<capture::FramePose>(&tracked.pose);
  if (!is_live || pose == nullptr || first_poses.size() >= enough) return;
  first_poses.push_back(pose->camera_from_board);
  if (first_poses.size() < enough || !needs_cameras(object_mesh)) return;
  core::Mesh copy = object_mesh;
  face_cameras(copy, session, first_poses, sink);
  if (copy.triangles != object_mesh.triangles || copy.normals != object_mesh.normals) {
    sink.note(session.mesh.string() +
              ": what is fitted now shows its inside; sheen replay of this session turns it");
  }
}

/// Nor can it be put right: its images are kept until the recording has ended.
void Reconstruction::Impl::look_at_place(const TrackedFrame& tracked) {
  const auto* pose = std::get_if<capture::FramePose>(&tracked.pose);
  if (!is_live || pose == nullptr || !may_measure_mesh() || !live_stills.is_due()) return;
  live_stills.add({tracked.frame.image, &session.camera_of(tracked.frame.index),
                   pose->camera_from_board * session.board_from_object});
}

void Reconstruction::Impl::tell_place(ProgressSink& sink) {
  const auto& images = live_stills.items();
  WithoutNotes unasked(sink);
  if (images.size() < kFewestMeasuringViews ||
      !are_poses_sound(session, pose_board(), images, unasked)) {
    return;
  }
  const auto found = place_mesh(object_mesh, images, options.threads, sink);
  if (found) evidence->note(found->finding("sheen replay of this session puts that right"));
}

/// What a pixel covers, supposing that the object fills the image where that is not known yet.
double Reconstruction::Impl::texel_size_m(const core::Mesh& surface) const {
  const auto footprint_m =
      is_live ? std::nullopt : pixel_footprint_m(session, surface, *pose_estimator());
  const double diagonal_m = static_cast<double>(core::bounds_of(surface).diagonal().norm());
  return footprint_m.value_or(diagonal_m / session.camera.height_px());
}

void Reconstruction::Impl::choose_texels() {
  const bool is_measured = texel_m && !(refinement && refinement->is_accepted);
  const double size_m = is_measured ? *texel_m : texel_size_m(mesh);
  if (options.patches == Patches::automatic && !are_finer_than_vertices(size_m, mesh)) {
    options.representation = kVertexPatches;
    options.patches = Patches::vertex;
    return;
  }
  if (options.patches == Patches::automatic) options.patches = Patches::detail;
  set_texel_size(size_m, options.fit);
}

std::unique_ptr<fitting::Fitter> Reconstruction::Impl::make_fitter(
    const std::string& name, const fitting::OptionValues& values,
    fitting::UndoableFitter*& undoable) {
  const auto make = [this, name, values] {
    return fitting::make_fitter(name, mesh, values, options.threads);
  };
  if (!options.undoable) return make();
  auto remembering = std::make_unique<fitting::UndoableFitter>(
      make, [this](std::span<const int> frames, const auto& observe) {
        std::vector<IntegratedView> views;
        for (const IntegratedView& view : stage->integrated()) {
          if (std::ranges::binary_search(frames, view.frame_index)) views.push_back(view);
        }
        // Of its own: the other one may be at work on the next frame's samples.
        ViewObserver again(mesh, make_visibility(visibility, mesh, options.threads), options.limits,
                           options.threads);
        replay_observations(session, object_mesh, views, again, depth ? &*depth : nullptr, observe);
      });
  undoable = remembering.get();
  return remembering;
}

/// Asks the listener, and where mismatches are refused what earlier views say.
bool Reconstruction::Impl::admit(const core::SampleBatch& batch, FrameListener* asked) {
  if (asked != nullptr) return asked->admit(batch);
  if (!score) return true;
  const auto verdict = model->with([&](const fitting::Fitter& fitted) {
    return score->judge(batch, *fitting::as_patches(fitted.light_field()));
  });
  if (verdict != fitting::guidance::FrameVerdict::fine) return false;
  score->note(batch, 0);
  return true;
}

/// Says every cause once, in the words of when it was first seen.
void Reconstruction::Impl::tell_new(const std::vector<Finding>& found, ProgressSink& sink) {
  for (const Finding& finding : found) {
    if (std::ranges::find(findings, finding.cause, &Finding::cause) != findings.end()) continue;
    sink.note(finding.line);
    findings.push_back(finding);
  }
}

/// Whoever records can still mend it.
void Reconstruction::Impl::tell_early(ProgressSink& sink) {
  if (!is_live || evidence->frames() < next_told) return;
  next_told *= 2;
  tell_new(evidence->faults(), sink);
}

void Reconstruction::Impl::finish() {
  const double start_ms = core::own_cpu_ms();
  model->finish();
  finish_cpu_ms = core::own_cpu_ms() - start_ms;
  if (mean) mean->finish();
}

Reconstruction::Reconstruction(ReconstructionInputs inputs, const ReconstructionOptions& options,
                               ProgressSink& sink)
    : impl_(std::make_unique<Impl>(std::move(inputs), options, sink)) {}

Reconstruction::~Reconstruction() = default;
Reconstruction::Reconstruction(Reconstruction&& other) noexcept = default;
Reconstruction& Reconstruction::operator=(Reconstruction&& other) noexcept = default;

void Reconstruction::run(ProgressSink& sink, FrameListener* listener) {
  impl_->listener = listener;
  const FrameStatistics& frames = impl_->stage->statistics();
  impl_->times =
      for_each_frame(*impl_->poses, impl_->options.threads > 1, [&](TrackedFrame& tracked) {
        if (const auto* pose = std::get_if<capture::FramePose>(&tracked.pose)) {
          impl_->scene.see(pose->camera_from_board);
        }
        impl_->look_at_sides(tracked, sink);
        impl_->look_at_place(tracked);
        impl_->stage->integrate(tracked);
        impl_->tell_early(sink);
        sink.progress({"fitting", frames.frames_read, impl_->frame_count.value_or(0),
                       fmt::format("{} posed", frames.posed.size())});
        if (listener != nullptr) listener->on_frame(tracked, frames);
      });
  const capture::SourceReport recording = impl_->poses->report();
  impl_->stage->note_damaged(recording.damaged);
  for (const std::string& note : recording.notes) sink.note(note);
  if (!frames.posed.empty()) impl_->scene.finish(sink);
  // A share of the patches may lie underneath.
  const bool seen = impl_->fitter->statistics().samples > 0 || !impl_->options.share.is_whole();
  check_something_was_seen(impl_->session, impl_->options.frames, frames, seen, impl_->scene);
  if (const auto fault = impl_->evidence->board_fault()) {
    throw core::bad_input(*impl_->session.board, fault->fault, fault->remedy);
  }
  for (const std::string& doubt : doubts_of_stamps(impl_->session, impl_->options.frames, frames)) {
    sink.note(doubt);
  }
  impl_->tell_place(sink);
  impl_->tell_new(impl_->evidence->findings(), sink);
  impl_->finish();
}

const capture::Session& Reconstruction::session() const {
  return impl_->session;
}

const core::Mesh& Reconstruction::mesh() const {
  return impl_->mesh;
}

const core::Mesh& Reconstruction::object_mesh() const {
  return impl_->object_mesh;
}

const ReconstructionOptions& Reconstruction::options() const {
  return impl_->options;
}

const fitting::LightField& Reconstruction::light_field() const {
  return impl_->fitter->light_field();
}

fitting::FitStatistics Reconstruction::fit_statistics() const {
  return impl_->fitter->statistics();
}

const fitting::LightField* Reconstruction::mean_colours() const {
  if (impl_->mean) return &impl_->mean->light_field();
  return impl_->options.representation == kMean ? &light_field() : nullptr;
}

const FrameStatistics& Reconstruction::frames() const {
  return impl_->stage->statistics();
}

const std::vector<Finding>& Reconstruction::findings() const {
  return impl_->findings;
}

const core::StageTimer& Reconstruction::times() const {
  return impl_->times;
}

double Reconstruction::finish_cpu_ms() const {
  return impl_->finish_cpu_ms;
}

const std::optional<capture::BoardRefinement>& Reconstruction::board_refinement() const {
  return impl_->board;
}

const std::optional<MeshPlacement>& Reconstruction::mesh_placement() const {
  return impl_->placement;
}

const std::optional<MeshRefinement>& Reconstruction::mesh_refinement() const {
  return impl_->refinement;
}

PosedFrame Reconstruction::refined(const capture::Frame& frame, const PosedFrame& posed) {
  return impl_->stage->refined(frame, posed);
}

SharedModel& Reconstruction::model() {
  return *impl_->model;
}

fitting::UndoableFitter* Reconstruction::history() {
  return impl_->history;
}

fitting::UndoableFitter* Reconstruction::mean_history() {
  return impl_->mean_history;
}

Reconstruction reconstruct(ReconstructionInputs inputs, const ReconstructionOptions& options,
                           ProgressSink& sink) {
  Reconstruction reconstruction(std::move(inputs), options, sink);
  reconstruction.run(sink);
  return reconstruction;
}

}  // namespace sheen::pipeline
