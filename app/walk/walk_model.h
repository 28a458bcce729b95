// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/live_session.h"
#include "app/walk/thread_pace.h"
#include "capture/source/frame_source.h"
#include "pipeline/options.h"
#include "pipeline/reconstruct.h"
#include "reconstruction/live/growing_hull.h"
#include "reconstruction/live/live_walk.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace sheen::app {

/// Whether a walk's shape is good enough for a light field to begin on it: somebody has looked from
/// every place round the object, at some height, and the hull is complete, made with the present
/// lens of three quarters of the views there are or more; or a third more views have hardly changed
/// it.
bool is_good_enough(const reconstruction::WalkSight& sight,
                    const reconstruction::GrowingHull::News& hull);

/// The frames of a source that lie `interval_s` apart at least, the first included.
std::unique_ptr<capture::FrameSource> thinned_in_time(std::unique_ptr<capture::FrameSource> source,
                                                      double interval_s);

/// The light field of a walk that goes on: once its shape is good enough the recording is fitted
/// on the coarse hull, from its first frame on, ten frames a
/// second, until it has caught up with the camera. All of it on one thread that takes half a core
/// at most and yields to all others (ThreadPace). A preview: the model that is kept is made from
/// the whole recording at full size when it has ended.
class WalkModel {
 public:
  struct Parts {
    std::filesystem::path session;  ///< the folder that is being recorded
    const reconstruction::LiveWalk& walk;
    std::function<reconstruction::GrowingHull::News()> hull;
    /// The recording from its first frame on, as it grows; its end must come when the recording
    /// ends.
    std::function<std::unique_ptr<capture::FrameSource>()> frames;
    pipeline::ReconstructionOptions options;
  };

  /// A light field that grows, and who may be asked about it. Board and object frame are one.
  struct Growth {
    std::unique_ptr<pipeline::Reconstruction> fitted;
    std::unique_ptr<LiveSession> live;  ///< last: it looks at the other
  };

  /// What the parts name outlives it.
  explicit WalkModel(Parts parts);

  /// Null before it has begun.
  [[nodiscard]] std::shared_ptr<Growth> growth() const;
  /// Why there is none, a sentence; empty: nothing was wrong.
  [[nodiscard]] std::string doubt() const;

 private:
  void run(const std::stop_token& stop);
  std::shared_ptr<Growth> begin(ThreadPace& pace);
  std::shared_ptr<Growth> begin_on(const core::Mesh& hull, const reconstruction::WalkViews& views,
                                   ThreadPace& pace);

  Parts parts_;
  mutable std::mutex mutex_;  ///< of what follows
  std::shared_ptr<Growth> growth_;
  std::string doubt_;
  std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace sheen::app
