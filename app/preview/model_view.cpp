// SPDX-License-Identifier: MIT
#include "app/preview/model_view.h"

#include "app/preview/drawn_part.h"
#include "app/preview/theme.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sheen::app {
namespace {

ImU32 colour_of(const ImVec4& colour, float strength) {
  return ImGui::GetColorU32({colour.x, colour.y, colour.z, strength});
}

/// Cameras far enough apart to be told from each other.
std::vector<const Eigen::Isometry3d*> thinned(const std::vector<Eigen::Isometry3d>& poses,
                                              double spacing_m) {
  std::vector<const Eigen::Isometry3d*> kept;
  Eigen::Vector3d last = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  for (const Eigen::Isometry3d& pose : poses) {
    const Eigen::Vector3d eye = pose.inverse().translation();
    if ((eye - last).norm() < spacing_m) continue;
    kept.push_back(&pose);
    last = eye;
  }
  return kept;
}

constexpr double kCamerasAt = 1.75;       // object radii from its centre
constexpr double kRoomForCameras = 1.75;  // so that most of them are in sight

}  // namespace

ModelView::ModelView(const render::gl::Functions& gl, const core::Mesh& mesh,
                     const Eigen::Vector3d& up, bool with_cameras)
    : mesh_(mesh),
      camera_(mesh, up, with_cameras ? kRoomForCameras : 1),
      caster_(mesh),
      target_(gl, render::gl::Colour::bytes) {}

void ModelView::paint(ObjectPainter& painter, Layer layer, bool hastily) {
  const Eigen::Isometry3d pose = camera_.camera_from_object();
  const bool as_before = layer == painted_layer_ && painter.version() == painted_version_ &&
                         pose.matrix() == painted_from_.matrix() &&
                         lens_.width_px() == painted_lens_.width_px() &&
                         lens_.height_px() == painted_lens_.height_px();
  if (as_before && is_fine_) return;
  is_fine_ = as_before;
  painted_layer_ = layer;
  painted_version_ = painter.version();
  painted_from_ = pose;
  painted_lens_ = lens_;
  drawn_part_ = drawn_part(painter.bounds(), lens_, pose);
  const double density = is_fine_ ? 2 : hastily ? 0.5 : 1;
  const auto dense = [&](int size_px) { return static_cast<int>(std::ceil(density * size_px)); };
  painter.draw(layer, target_, OrbitCamera::lens(dense(lens_.width_px()), dense(lens_.height_px())),
               pose);
}

void ModelView::show(const ImVec2& corner, const ImVec2& size, const ViewState& state,
                     const CameraTrail& trail, bool is_large) {
  // The image is painted as large as it is shown, from the next redraw on.
  const ImVec2 density = ImGui::GetIO().DisplayFramebufferScale;
  lens_ = OrbitCamera::lens(std::max(1, static_cast<int>(size.x * density.x)),
                            std::max(1, static_cast<int>(size.y * density.y)));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end(corner.x + size.x, corner.y + size.y);
  list.PushClipRect(corner, end, true);
  // The window is cleared to the background already.
  if (!is_large) list.AddRectFilled(corner, end, ImGui::GetColorU32(theme::kBackground));
  if (target_.colour_texture() != 0) {
    add_part(list, target_.colour_texture(), corner, size, drawn_part_);
  }
  const ImVec2 scale(size.x / static_cast<float>(lens_.width_px()),
                     size.y / static_cast<float>(lens_.height_px()));
  draw_cameras(Overlay(list, corner, scale, lens_, painted_from_), trail, state.path && is_large);
  list.PopClipRect();

  under_cursor_.reset();
  if (is_large) take_mouse(corner, size);
}

void ModelView::take_mouse(const ImVec2& corner, const ImVec2& size) {
  ImGui::SetCursorScreenPos(corner);
  ImGui::InvisibleButton("model", size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  const ImGuiIO& io = ImGui::GetIO();
  const Eigen::Vector2d drag(static_cast<double>(io.MouseDelta.x),
                             static_cast<double>(io.MouseDelta.y));
  if (ImGui::IsItemActive()) {
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
      camera_.orbit(drag, static_cast<double>(size.y));
    } else {
      camera_.pan(drag, static_cast<double>(size.y));
    }
  }
  if (!ImGui::IsItemHovered()) return;
  if (io.MouseWheel != 0) camera_.zoom(static_cast<double>(io.MouseWheel));
  const Eigen::Vector2d pixel(
      static_cast<double>((io.MousePos.x - corner.x) / size.x) * lens_.width_px() - 0.5,
      static_cast<double>((io.MousePos.y - corner.y) / size.y) * lens_.height_px() - 0.5);
  if (!ImGui::IsItemActive()) under_cursor_ = vertex_at(pixel);
}

std::optional<std::uint32_t> ModelView::vertex_at(const Eigen::Vector2d& pixel) const {
  const auto ray = lens_.unproject(pixel);
  if (!ray) return std::nullopt;
  const Eigen::Isometry3d object_from_camera = painted_from_.inverse();
  const Eigen::Vector3f direction = (object_from_camera.linear() * *ray).cast<float>();
  const auto hit = caster_.first_hit(object_from_camera.translation().cast<float>(), direction, 0,
                                     std::numeric_limits<float>::infinity());
  if (!hit) return std::nullopt;
  Eigen::Index corner = 0;
  hit->barycentric.maxCoeff(&corner);
  return mesh_.triangles[hit->triangle_idx][corner];
}

Eigen::Isometry3d ModelView::brought_near(const Eigen::Isometry3d& camera_from_object,
                                          double factor) const {
  Eigen::Isometry3d object_from_camera = camera_from_object.inverse();
  const Eigen::Vector3d& centre = camera_.object_centre();
  object_from_camera.translation() = centre + factor * (object_from_camera.translation() - centre);
  return object_from_camera.inverse();
}

void ModelView::draw_cameras(const Overlay& overlay, const CameraTrail& trail,
                             bool with_path) const {
  if (trail.lens == nullptr || !trail.present) return;
  const Eigen::Vector3d& centre = camera_.object_centre();
  const double radius_m = camera_.object_radius_m();
  const auto eye = [](const Eigen::Isometry3d& pose) -> Eigen::Vector3d {
    return pose.inverse().translation();
  };
  const Eigen::Isometry3d& first = trail.poses.empty() ? *trail.present : trail.poses.front();
  const double factor = kCamerasAt * radius_m / std::max((eye(first) - centre).norm(), radius_m);
  const double depth_m = 0.16 * radius_m;
  const float line = ImGui::GetFontSize() / 11;
  if (with_path) {
    std::vector<Eigen::Isometry3d> near;
    std::vector<Eigen::Vector3d> places;
    for (const Eigen::Isometry3d& pose : trail.poses) {
      near.push_back(brought_near(pose, factor));
      places.push_back(eye(near.back()));
    }
    overlay.path(places, colour_of(theme::kQuiet, 0.4f), line);
    for (const Eigen::Isometry3d* pose : thinned(near, 0.3 * radius_m)) {
      overlay.frustum(*trail.lens, *pose, 0.6 * depth_m, colour_of(theme::kQuiet, 0.6f),
                      0.7f * line);
    }
  }
  for (const Eigen::Vector3d& direction : trail.missing) {
    overlay.dot(centre + kCamerasAt * radius_m * direction, 2 * line,
                colour_of(theme::kWarning, 0.7f));
  }
  const Eigen::Isometry3d present = brought_near(*trail.present, factor);
  overlay.frustum(*trail.lens, present, depth_m, colour_of(theme::kText, 0.95f), line);
  if (!trail.hint) return;
  const Eigen::Vector3d goal = centre + factor * (*trail.hint - centre);
  overlay.frustum(*trail.lens, looking_at(goal, centre, camera_.up()), depth_m,
                  colour_of(theme::kWarning, 0.85f), line);
  overlay.arrow(arc_between(eye(present), goal, centre), colour_of(theme::kWarning, 0.9f),
                1.6f * line);
}

}  // namespace sheen::app
