// SPDX-License-Identifier: MIT
#include "app/walk/walk_model.h"

#include "capture/pose/board.h"
#include "capture/session/new_session.h"
#include "capture/session/session.h"
#include "core/diagnostics/error.h"
#include "core/mesh/read_mesh.h"
#include "reconstruction/live/view_directions.h"

#include <stdlib.h>

#include <algorithm>
#include <array>
#include <exception>
#include <utility>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

constexpr double kLookAgain_s = 0.3;
constexpr double kFrameInterval_s = 0.095;  // ten a second, of 30 exactly every third

/// Board and mesh are read as files of a session are.
class TemporaryFiles {
 public:
  TemporaryFiles() {
    std::string name = (fs::temp_directory_path() / "sheen-walk-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw core::Error(core::Error::Kind::run_failed, fs::temp_directory_path(),
                        "takes no temporary folder", "check free space and permissions");
    }
    folder_ = name;
  }
  ~TemporaryFiles() {
    std::error_code no_throw;
    fs::remove_all(folder_, no_throw);
  }
  TemporaryFiles(const TemporaryFiles&) = delete;
  TemporaryFiles& operator=(const TemporaryFiles&) = delete;
  TemporaryFiles(TemporaryFiles&&) = delete;
  TemporaryFiles& operator=(TemporaryFiles&&) = delete;

  [[nodiscard]] fs::path operator/(const char* name) const { return folder_ / name; }

 private:
  fs::path folder_;
};

class ThinnedSource final : public capture::FrameSource {
 public:
  ThinnedSource(std::unique_ptr<capture::FrameSource> source, double interval_s)
      : source_(std::move(source)), interval_s_(interval_s) {}

  std::optional<capture::Frame> next() override {
    while (auto frame = source_->next()) {
      if (due_s_ && frame->time_s < *due_s_) continue;
      due_s_ = frame->time_s + interval_s_;
      return frame;
    }
    return std::nullopt;
  }
  [[nodiscard]] std::optional<int> frame_count() const override { return std::nullopt; }
  [[nodiscard]] capture::SourceReport report() const override { return source_->report(); }

 private:
  std::unique_ptr<capture::FrameSource> source_;
  double interval_s_;
  std::optional<double> due_s_;
};

/// Says nothing and rests between pieces of work.
class PacedSink final : public pipeline::ProgressSink {
 public:
  explicit PacedSink(ThreadPace& pace) : pace_(pace) {}
  void progress(const pipeline::StepProgress& /*step*/) override { pace_.rest(); }

 private:
  ThreadPace& pace_;
};

pipeline::ReconstructionOptions preview_options(pipeline::ReconstructionOptions options) {
  options.threads = 1;
  options.frames = {};  // --start, --end and --hold-out are of the model that is kept
  options.frames.pose_source = pipeline::PoseSource::tags;
  options.share = {};
  options.refine_board = false;
  options.refine_mesh = false;
  options.with_mean = false;
  options.undoable = false;
  return options;
}

}  // namespace

bool is_good_enough(const reconstruction::WalkSight& sight,
                    const reconstruction::GrowingHull::News& hull) {
  using reconstruction::kViewPlaces;
  const std::size_t known = reconstruction::kViewDirections - sight.missing.size();
  const bool is_made_of_most = hull.views > 0 && 4 * hull.views >= 3 * known;
  if (hull.hull == nullptr || !hull.doubt.empty()) return false;
  if (!(hull.is_settled || is_made_of_most)) return false;
  std::array<std::size_t, kViewPlaces> missing_heights{};
  for (const std::size_t direction : sight.missing) ++missing_heights[direction % kViewPlaces];
  constexpr std::size_t heights = reconstruction::kViewDirections / kViewPlaces;
  return std::ranges::none_of(missing_heights,
                              [](std::size_t missing) { return missing == heights; });
}

std::unique_ptr<capture::FrameSource> thinned_in_time(std::unique_ptr<capture::FrameSource> source,
                                                      double interval_s) {
  return std::make_unique<ThinnedSource>(std::move(source), interval_s);
}

WalkModel::WalkModel(Parts parts)
    : parts_(std::move(parts)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

std::shared_ptr<WalkModel::Growth> WalkModel::growth() const {
  const std::lock_guard lock(mutex_);
  return growth_;
}

std::string WalkModel::doubt() const {
  const std::lock_guard lock(mutex_);
  return doubt_;
}

void WalkModel::run(const std::stop_token& stop) {
  try {
    ThreadPace pace(stop);
    const auto growth = begin(pace);
    PacedSink sink(pace);
    growth->fitted->run(sink, growth->live.get());
    growth->live->finish();
  } catch (const ThreadPace::Stopped&) {   // nobody looks any more
  } catch (const std::exception& error) {  // a preview that fails ends no capture
    const std::lock_guard lock(mutex_);
    doubt_ = error.what();
  }
}

std::shared_ptr<WalkModel::Growth> WalkModel::begin(ThreadPace& pace) {
  while (true) {
    const auto views = parts_.walk.views();
    const auto hull = parts_.hull();
    if (views && is_good_enough(parts_.walk.sight(), hull)) {
      return begin_on(*hull.hull, *views, pace);
    }
    pace.wait(kLookAgain_s);
  }
}

std::shared_ptr<WalkModel::Growth> WalkModel::begin_on(const core::Mesh& hull,
                                                       const reconstruction::WalkViews& views,
                                                       ThreadPace& pace) {
  const TemporaryFiles files;
  core::write_ply(files / "object.ply", hull);
  capture::write_board(files / "board.yaml", views.board);
  capture::Session session = capture::open_unfinished_session(parts_.session);
  session.camera = parts_.walk.sight().camera;
  session.board = files / "board.yaml";
  session.poses.reset();
  session.mesh = files / "object.ply";
  session.board_from_object = Eigen::Isometry3d::Identity();
  const auto options = preview_options(parts_.options);
  PacedSink sink(pace);
  auto growth = std::make_shared<Growth>();
  growth->fitted = std::make_unique<pipeline::Reconstruction>(
      pipeline::ReconstructionInputs{.session = session,
                                     .frames = thinned_in_time(parts_.frames(), kFrameInterval_s),
                                     .is_live = true},
      options, sink);
  growth->live = std::make_unique<LiveSession>(
      LiveSession::Parts{.model = growth->fitted->model(),
                         .history = nullptr,
                         .baseline = nullptr,
                         .mesh = growth->fitted->mesh(),
                         .camera = growth->fitted->session().camera,
                         .board_from_object = growth->fitted->session().board_from_object,
                         .limits = options.limits,
                         .is_camera = true});
  const std::lock_guard lock(mutex_);
  growth_ = growth;
  return growth;
}

}  // namespace sheen::app
