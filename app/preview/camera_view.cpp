// SPDX-License-Identifier: MIT
#include "app/preview/camera_view.h"

#include "app/preview/drawn_part.h"
#include "app/preview/theme.h"

#include <algorithm>
#include <cmath>

namespace sheen::app {
namespace {

/// The same camera with another number of pixels.
core::CameraModel resized(const core::CameraModel& camera, double scale) {
  core::CameraModel::Intrinsics intrinsics = camera.intrinsics();
  intrinsics.width_px = std::max(1, static_cast<int>(std::lround(intrinsics.width_px * scale)));
  intrinsics.height_px = std::max(1, static_cast<int>(std::lround(intrinsics.height_px * scale)));
  intrinsics.focal_px *= scale;
  // Pixel (0, 0) is the centre of the first pixel, not its corner.
  intrinsics.principal_px = (intrinsics.principal_px.array() + 0.5) * scale - 0.5;
  return core::CameraModel(intrinsics);
}

}  // namespace

void CameraView::take(const cv::Mat& image, const core::CameraModel& camera,
                      const std::optional<Eigen::Isometry3d>& camera_from_object) {
  image_.upload(image);
  camera_ = camera;
  camera_from_object_ = camera_from_object;
  is_new_ = true;
}

void CameraView::paint(ObjectPainter& painter, const ViewState& state) {
  const bool was_painted = is_painted_;
  is_painted_ = state.overlay && camera_from_object_ && scale_ > 0;
  if (!is_painted_) return;
  const bool as_before = was_painted && !is_new_ && state.layer == painted_layer_ &&
                         painter.version() == painted_version_ && scale_ == painted_scale_;
  if (as_before) return;
  is_new_ = false;
  painted_layer_ = state.layer;
  painted_version_ = painter.version();
  painted_scale_ = scale_;
  drawn_part_ = drawn_part(painter.bounds(), camera_, *camera_from_object_);
  painter.draw(state.layer, target_, resized(camera_, std::min(scale_, 1.0)), *camera_from_object_);
}

void CameraView::show(const ImVec2& corner, const ImVec2& size, const ViewState& state) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y},
                     ImGui::GetColorU32(theme::kBackground));
  if (image_.name() == 0) return;
  const float fit = std::min(size.x / static_cast<float>(camera_.width_px()),
                             size.y / static_cast<float>(camera_.height_px()));
  scale_ = static_cast<double>(fit * ImGui::GetIO().DisplayFramebufferScale.x);
  const ImVec2 shown(fit * static_cast<float>(camera_.width_px()),
                     fit * static_cast<float>(camera_.height_px()));
  const ImVec2 from(corner.x + 0.5f * (size.x - shown.x), corner.y + 0.5f * (size.y - shown.y));
  const Eigen::AlignedBox2f whole(Eigen::Vector2f::Zero(), Eigen::Vector2f::Ones());
  add_part(list, image_.name(), from, shown, whole);
  if (!is_painted_) return;
  // Radiance covers the object so that the two can be compared; scores let it shine through.
  const float strength = state.layer == Layer::radiance ? 1.0f : 0.75f;
  add_part(list, target_.colour_texture(), from, shown, drawn_part_, strength);
}

}  // namespace sheen::app
