// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/live_status.h"
#include "app/preview/next_best_view_planner.h"
#include "core/geometry/camera.h"
#include "fitting/guidance/capture_score.h"
#include "fitting/undo/undoable_fitter.h"
#include "pipeline/reconstruct.h"

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace sheen::app {

/// Between a pipeline that fits frames and a window that shows it. The pipeline tells and obeys
/// between frames; the window looks and asks. Neither waits for the other, except that a paused
/// pipeline waits to go on.
class LiveSession final : public pipeline::FrameListener {
 public:
  struct Parts {
    pipeline::SharedModel& model;       ///< over `history`
    fitting::UndoableFitter* history;   ///< null: nothing can be taken back
    fitting::UndoableFitter* baseline;  ///< is undone with it; may be null
    const core::Mesh& mesh;
    core::CameraModel camera;
    Eigen::Isometry3d board_from_object;
    core::SamplingLimits limits;
    /// Frames come whether or not they are wanted: while paused they are not taken in. A recording
    /// waits instead.
    bool is_camera = false;
    bool refuse_faults = false;  ///< keep frames out that contradict the model
    /// Saves the model as it is; returns what to tell. Called with nobody else at the model.
    /// Empty: there is nothing to save it to.
    std::function<std::string(const fitting::LightField&)> save = {};
  };

  explicit LiveSession(Parts parts);

  // The pipeline's side, on the thread that fits.

  /// Judges samples that are about to be taken in .
  bool admit(const core::SampleBatch& batch) override;
  /// After every frame: tells the window, waits while paused, does what was asked for.
  void on_frame(const pipeline::TrackedFrame& tracked,
                const pipeline::FrameStatistics& statistics) override;
  /// The last frame was fitted. Requests are no longer heard: an undo that came too late is told, a
  /// save would give the model that the program writes at its end.
  void finish();

  // The window's side, from any thread.

  [[nodiscard]] LiveStatus status() const;
  /// Poses of the cameras that were fitted, from the `known`-th on, camera_from_object; starts anew
  /// (second: false) when `known` are no longer true after an undo.
  struct PathNews {
    std::vector<Eigen::Isometry3d> poses;
    std::size_t generation = 0;  ///< grows with every undo: forget what you know
  };
  [[nodiscard]] PathNews path_since(std::size_t known, std::size_t generation) const;
  /// Advice of the planner that has not been fetched yet.
  std::optional<PlannerAdvice> take_advice();
  [[nodiscard]] fitting::guidance::PatchKnowledge knowledge_of(std::size_t patch_idx) const;

  /// Shows the model and what changed since the last look, unless it is being fitted just now.
  /// After an undo (`undos` has grown) it is another object. Returns whether there was a look.
  using Look = std::function<void(const fitting::LightField&, const fitting::ModelUpdate& changes,
                                  std::size_t undos)>;
  bool try_look(const Look& look);

  void set_paused(bool paused);
  /// Forgets what the last seconds of the recording brought, between two frames.
  void request_undo(double seconds);
  void request_save();
  /// Nobody looks any more: whoever is paused goes on.
  void close();
  /// Called when there is something new to see, from the pipeline's threads.
  void set_wake(std::function<void()> wake);

  [[nodiscard]] const core::Mesh& mesh() const { return parts_.mesh; }
  [[nodiscard]] const core::CameraModel& camera() const { return parts_.camera; }
  /// Upright axis of the stage in the object's frame.
  [[nodiscard]] Eigen::Vector3d up() const {
    return parts_.board_from_object.linear().row(2).transpose();
  }

 private:
  struct FittedView {
    double time_s;
    Eigen::Isometry3d camera_from_object;
  };
  struct Requests {
    bool paused = false;
    double undo_s = 0;
    bool save = false;
    bool closed = false;
  };

  void publish(const pipeline::TrackedFrame& tracked, const pipeline::FrameStatistics& statistics);
  void note_times(const core::StageTimes& times);
  void obey();
  void undo(double seconds);
  void save();
  std::optional<PlannerInput> what_is_known() const;
  void take(PlannerAdvice advice);
  void wake() const;

  Parts parts_;
  mutable std::mutex mutex_;  ///< of everything below
  std::condition_variable asked_;
  Requests requests_;
  LiveStatus status_;
  fitting::guidance::CaptureScore score_;
  std::vector<FittedView> views_;
  std::size_t generation_ = 0;
  bool admitted_ = false;  ///< the frame under way has been taken in
  std::string verdict_;    ///< why the frame under way is doubted, in words
  std::map<std::string, int> doubts_;
  std::map<std::string, std::deque<double>, std::less<>> recent_ms_;
  std::optional<PlannerAdvice> advice_;
  std::function<void()> wake_;
  std::optional<NextBestViewPlanner> planner_;  // last: its thread uses the others
};

}  // namespace sheen::app
