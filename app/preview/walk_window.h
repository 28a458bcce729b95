// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/camera_view.h"
#include "app/preview/commands.h"
#include "app/preview/model_feed.h"
#include "app/preview/model_view.h"
#include "app/preview/object_painter.h"
#include "app/preview/walk_subject.h"
#include "app/preview/window.h"
#include "app/preview/window_layout.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sheen::app {

/// The window over a walk whose object has no mesh yet: the camera's image, the hull as it grows,
/// the cameras round it and the directions that nobody has looked from; once the shape is good
/// enough the light field as it grows instead of the hull. Lives on the main thread.
class WalkWindow {
 public:
  /// Throws core::Error (run_failed) without a display.
  explicit WalkWindow(WalkSubject subject);

  /// Waits for something to happen, at most this long, and draws once. False when the window is to
  /// be closed.
  bool redraw(double longest_wait_s);

 private:
  /// A hull, or a light field, and what draws it.
  struct ShownObject {
    ShownObject(Window& window, const core::Mesh& mesh);
    // First, since the others draw its mesh: one of the two.
    std::shared_ptr<const core::Mesh> hull = {};
    std::shared_ptr<WalkModel::Growth> growth = {};
    ObjectPainter painter;
    ModelView view;
    std::optional<ModelFeed> feed = {};          ///< of the light field
    std::vector<Eigen::Isometry3d> fitted = {};  ///< cameras that it has seen
  };

  void take_news();
  void show_hull(std::shared_ptr<const core::Mesh> hull);
  void show_light_field(std::shared_ptr<WalkModel::Growth> growth);
  void show_instead(std::unique_ptr<ShownObject> next);
  void take_light_field_news();
  void paint();
  void paint_views();
  void look_for_missing();
  void lay_out();
  void show_views(const layout::Area& area);
  void show_panel(const layout::Area& area);
  void show_shape_state() const;
  void show_light_field_state() const;
  void obey(ViewCommand command);

  WalkSubject subject_;
  Window window_;
  CameraView camera_view_;
  std::unique_ptr<ShownObject> object_;  ///< null before there is one
  ViewState state_{.layer = Layer::mesh};
  reconstruction::WalkSight sight_;
  reconstruction::GrowingHull::News news_;
  LiveStatus status_;  ///< of the light field
  CameraTrail trail_;
  bool snapshot_wanted_ = false;
  std::string note_;  ///< what became of the last snapshot
};

}  // namespace sheen::app
