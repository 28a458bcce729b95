// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/object_painter.h"
#include "app/preview/view_state.h"
#include "render/preview/image_texture.h"

#include <Eigen/Geometry>
#include <imgui.h>

#include <optional>

namespace sheen::app {

/// The camera's image with the object drawn over it where the pose says it is.
class CameraView {
 public:
  explicit CameraView(const render::gl::Functions& gl)
      : image_(gl), target_(gl, render::gl::Colour::bytes) {}

  /// A new image and where it was taken from; no pose: nothing is drawn over it.
  void take(const cv::Mat& image, const core::CameraModel& camera,
            const std::optional<Eigen::Isometry3d>& camera_from_object);

  /// Draws the object over the image, unless nothing has changed since it last did.
  void paint(ObjectPainter& painter, const ViewState& state);
  /// Fills a rectangle of the present ImGui window, the image as large as fits.
  void show(const ImVec2& corner, const ImVec2& size, const ViewState& state);

 private:
  render::ImageTexture image_;
  render::gl::OffscreenTarget target_;
  core::CameraModel camera_;
  double scale_ = 0;  ///< pixels of the screen per pixel of the image; 0: not shown yet
  std::optional<Eigen::Isometry3d> camera_from_object_;
  bool is_painted_ = false;
  bool is_new_ = false;  ///< image and pose, since the object was last drawn over them
  Layer painted_layer_ = Layer::mesh;
  std::size_t painted_version_ = 0;
  double painted_scale_ = 0;
  Eigen::AlignedBox2f drawn_part_;
};

}  // namespace sheen::app
