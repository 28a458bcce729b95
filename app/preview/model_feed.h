// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/live_session.h"
#include "app/preview/model_view.h"
#include "app/preview/object_painter.h"

#include <functional>
#include <memory>
#include <vector>

namespace sheen::app {

/// Brings what a live session learns to a window, piece by piece, whenever the fit leaves the model
/// alone.
class ModelFeed {
 public:
  /// Both outlive it; the painter is of the session's mesh.
  ModelFeed(LiveSession& live, ObjectPainter& painter) : live_(live), painter_(painter) {}

  /// Cameras that were fitted, all of them after an undo, and scores.
  void take_news(std::vector<Eigen::Isometry3d>& path);
  /// Sends some of what has changed, and calls `draw` while the model keeps still where the painter
  /// draws from the model itself. Without effect while the fit has it.
  void look(const std::function<void()>& draw);

  /// Direction cells that a camera could see of every patch; null before they are known.
  [[nodiscard]] const std::vector<fitting::guidance::DirectionCells>* reachable() const {
    return reachable_.get();
  }

 private:
  LiveSession& live_;
  ObjectPainter& painter_;
  std::size_t generation_ = 0;
  std::size_t undos_ = 0;
  bool has_model_ = false;
  std::shared_ptr<const std::vector<fitting::guidance::DirectionCells>> reachable_;
};

}  // namespace sheen::app
