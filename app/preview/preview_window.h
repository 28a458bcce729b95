// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/camera_view.h"
#include "app/preview/live_session.h"
#include "app/preview/model_feed.h"
#include "app/preview/model_view.h"
#include "app/preview/object_painter.h"
#include "app/preview/preview_subject.h"
#include "app/preview/redraw_pace.h"
#include "app/preview/side_panel.h"
#include "app/preview/window.h"
#include "app/preview/window_layout.h"
#include "fitting/light_field.h"

#include <Eigen/Core>

#include <filesystem>
#include <optional>
#include <string>

namespace sheen::app {

/// The window over a subject. Lives on the main thread.
class PreviewWindow {
 public:
  /// Throws core::Error (run_failed) without a display.
  explicit PreviewWindow(const PreviewSubject& subject);

  /// Waits for something to happen, at most this long, and draws once. False when the window is to
  /// be closed.
  bool redraw(double longest_wait_s);

  /// Does what a key or button would.
  void obey(ViewCommand command);

  [[nodiscard]] const ViewState& state() const { return state_; }
  [[nodiscard]] OrbitCamera& camera() { return model_view_.camera(); }
  /// The window as last drawn, CV_8UC3 BGR.
  [[nodiscard]] const cv::Mat& image() const { return image_; }

 private:
  void take_news();
  void paint_views();
  void paint();
  void lay_out();
  void show_views(const layout::Area& area);
  void show_panel(const layout::Area& area);
  [[nodiscard]] std::optional<PatchNews> patch_news();
  void obey_session(ViewCommand command);
  void save_snapshot();

  PreviewSubject subject_;
  Window window_;
  ObjectPainter painter_;
  ModelView model_view_;
  CameraView camera_view_;
  ViewState state_;
  LiveStatus status_;
  int shown_frame_ = -1;  ///< frames_read when the image was taken over
  CameraTrail trail_;
  std::optional<ModelFeed> feed_;  ///< of a live session
  bool snapshot_wanted_ = false;
  std::string note_;
  cv::Mat image_;
  RedrawPace pace_;
};

}  // namespace sheen::app
