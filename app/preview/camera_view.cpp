// SPDX-License-Identifier: MIT
#include "app/preview/camera_view.h"

#include "app/preview/theme.h"

#include <algorithm>
#include <cmath>

namespace sheen::app {
namespace {

ImTextureID texture_id(GLuint name) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(name));
}

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

void CameraView::take(const cv::Mat& picture, const core::CameraModel& camera,
                      const std::optional<Eigen::Isometry3d>& camera_from_object) {
  picture_.upload(picture);
  camera_ = camera;
  camera_from_object_ = camera_from_object;
}

void CameraView::paint(ObjectPainter& painter, const ViewState& state) {
  is_painted_ = state.overlay && camera_from_object_ && scale_ > 0;
  if (!is_painted_) return;
  painter.draw(state.layer, target_, resized(camera_, std::min(scale_, 1.0)), *camera_from_object_);
}

void CameraView::show(const ImVec2& corner, const ImVec2& size, const ViewState& state) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y},
                     ImGui::GetColorU32(theme::kBackground));
  if (picture_.name() == 0) return;
  const float fit = std::min(size.x / static_cast<float>(camera_.width_px()),
                             size.y / static_cast<float>(camera_.height_px()));
  scale_ = static_cast<double>(fit * ImGui::GetIO().DisplayFramebufferScale.x);
  const ImVec2 shown(fit * static_cast<float>(camera_.width_px()),
                     fit * static_cast<float>(camera_.height_px()));
  const ImVec2 from(corner.x + 0.5f * (size.x - shown.x), corner.y + 0.5f * (size.y - shown.y));
  const ImVec2 to(from.x + shown.x, from.y + shown.y);
  list.AddImage(texture_id(picture_.name()), from, to);
  if (!is_painted_) return;
  // Radiance covers the object so that the two can be compared; scores let it shine through.
  const float strength = state.layer == Layer::radiance ? 1.0f : 0.75f;
  list.AddImage(texture_id(target_.colour_texture()), from, to, {0, 0}, {1, 1},
                ImGui::GetColorU32({1, 1, 1, strength}));
}

}  // namespace sheen::app
