// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/camera_view.h"
#include "app/preview/model_view.h"
#include "app/preview/object_painter.h"
#include "app/preview/walk_subject.h"
#include "app/preview/window.h"
#include "app/preview/window_layout.h"

#include <memory>
#include <string>

namespace sheen::app {

/// The window over a walk whose object has no mesh yet: the camera's image, the hull as it grows,
/// the cameras round it and the directions that nobody has looked from. Lives on the main thread.
class WalkWindow {
 public:
  /// Throws core::Error (run_failed) without a display.
  explicit WalkWindow(WalkSubject subject);

  /// Waits for something to happen, at most this long, and draws once. False when the window is to
  /// be closed.
  bool redraw(double longest_wait_s);

 private:
  /// A hull and what draws it.
  struct ShownHull {
    ShownHull(Window& window, std::shared_ptr<const core::Mesh> hull);
    std::shared_ptr<const core::Mesh> mesh;
    ObjectPainter painter;
    ModelView view;
  };

  void take_news();
  void show_hull(std::shared_ptr<const core::Mesh> hull);
  void look_for_missing();
  void lay_out();
  void show_views(const layout::Area& area);
  void show_panel(const layout::Area& area) const;
  void obey(const KeyPress& press);

  WalkSubject subject_;
  Window window_;
  CameraView camera_view_;
  std::unique_ptr<ShownHull> hull_;  ///< null before there is one
  ViewState state_{.layer = Layer::mesh};
  reconstruction::WalkSight sight_;
  reconstruction::GrowingHull::News news_;
  CameraTrail trail_;
  bool snapshot_wanted_ = false;
  std::string note_;  ///< what became of the last snapshot
};

}  // namespace sheen::app
