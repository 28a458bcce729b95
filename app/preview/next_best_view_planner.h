// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/object_painter.h"
#include "core/mesh/mesh.h"
#include "core/samples/vertex_view.h"
#include "fitting/guidance/view_utility.h"

#include <Eigen/Core>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace sheen::app {

/// What guidance needs to know, and what it says.
struct PlannerInput {
  fitting::guidance::ViewUtility utility;
  Eigen::Vector3f eye;  ///< present camera, object frame, metres
};
struct PlannerAdvice {
  PatchScores scores;
  double coverage = 0;
  std::optional<Eigen::Vector3f> next_best_view;  ///< object frame, metres
  std::shared_ptr<const std::vector<fitting::guidance::DirectionCells>> reachable;
};

/// Thinks about missing views in the background, on a thread of its own that rests longer than it
/// works, so that the capture keeps the processor.
class NextBestViewPlanner {
 public:
  struct Parts {
    const core::Mesh& mesh;  ///< outlives the planner
    Eigen::Vector3f up;      ///< upright axis in the object frame
    core::SamplingLimits limits;
    std::function<std::optional<PlannerInput>()> ask;  ///< nothing: no camera has been posed yet
    std::function<void(PlannerAdvice)> tell;
  };

  explicit NextBestViewPlanner(Parts parts);

 private:
  void run(const std::stop_token& stop);
  /// False when it is to stop.
  bool rest(const std::stop_token& stop, std::chrono::nanoseconds length);

  Parts parts_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace sheen::app
