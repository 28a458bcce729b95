// SPDX-License-Identifier: MIT
#include "app/preview/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sheen::app {

Overlay::Overlay(ImDrawList& list, const ImVec2& origin, const ImVec2& scale,
                 const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object)
    : list_(list),
      origin_(origin),
      scale_(scale),
      camera_(camera),
      camera_from_object_(camera_from_object) {}

std::optional<ImVec2> Overlay::place(const Eigen::Vector3d& point_in_object) const {
  const auto pixel = camera_.project(camera_from_object_ * point_in_object);
  if (!pixel || pixel->cwiseAbs().maxCoeff() > 1e5) return std::nullopt;
  return ImVec2(origin_.x + scale_.x * static_cast<float>(pixel->x() + 0.5),
                origin_.y + scale_.y * static_cast<float>(pixel->y() + 0.5));
}

void Overlay::line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, ImU32 colour,
                   float thickness) const {
  const auto a = place(from);
  const auto b = place(to);
  if (a && b) list_.AddLine(*a, *b, colour, thickness);
}

void Overlay::frustum(const core::CameraModel& lens, const Eigen::Isometry3d& lens_from_object,
                      double depth_m, ImU32 colour, float thickness) const {
  const Eigen::Isometry3d object_from_lens = lens_from_object.inverse();
  const auto& intrinsics = lens.intrinsics();
  const double half_width = 0.5 * intrinsics.width_px / intrinsics.focal_px.x() * depth_m;
  const double half_height = 0.5 * intrinsics.height_px / intrinsics.focal_px.y() * depth_m;
  std::array<Eigen::Vector3d, 4> base;
  constexpr std::array<std::array<double, 2>, 4> corners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    base[i] = object_from_lens *
              Eigen::Vector3d(corners[i][0] * half_width, corners[i][1] * half_height, depth_m);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    line(object_from_lens.translation(), base[i], colour, thickness);
    line(base[i], base[(i + 1) % 4], colour, thickness);
  }
}

void Overlay::path(const std::vector<Eigen::Vector3d>& places, ImU32 colour,
                   float thickness) const {
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    line(places[i], places[i + 1], colour, thickness);
  }
}

void Overlay::dot(const Eigen::Vector3d& place_in_object, float radius, ImU32 colour) const {
  if (const auto middle = place(place_in_object)) list_.AddCircleFilled(*middle, radius, colour);
}

void Overlay::arrow(const std::vector<Eigen::Vector3d>& places, ImU32 colour,
                    float thickness) const {
  path(places, colour, thickness);
  if (places.size() < 2) return;
  const auto tip = place(places.back());
  const auto tail = place(places[places.size() - 2]);
  if (!tip || !tail) return;
  const Eigen::Vector2f way(tip->x - tail->x, tip->y - tail->y);
  if (way.norm() < 1e-3f) return;
  const Eigen::Vector2f along = 5 * thickness * way.normalized();
  const Eigen::Vector2f across(-0.55f * along.y(), 0.55f * along.x());
  list_.AddTriangleFilled({tip->x + 0.6f * along.x(), tip->y + 0.6f * along.y()},
                          {tip->x - along.x() + across.x(), tip->y - along.y() + across.y()},
                          {tip->x - along.x() - across.x(), tip->y - along.y() - across.y()},
                          colour);
}

std::vector<Eigen::Vector3d> arc_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                         const Eigen::Vector3d& centre) {
  constexpr int steps = 24;
  const Eigen::Vector3d a = from - centre;
  const Eigen::Vector3d b = to - centre;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(a, b);
  std::vector<Eigen::Vector3d> arc;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const double radius = std::max((1 - t) * a.norm() + t * b.norm(), 1e-9);
    const Eigen::Vector3d direction =
        Eigen::Quaterniond::Identity().slerp(t, turn) * a.normalized();
    arc.push_back(centre + radius * direction);
  }
  return arc;
}

Eigen::Isometry3d looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& centre,
                             const Eigen::Vector3d& up) {
  const Eigen::Vector3d forward = (centre - eye).normalized();
  Eigen::Vector3d right = forward.cross(up);
  if (right.norm() < 1e-6) right = forward.unitOrthogonal();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear().row(0) = right.normalized().transpose();
  pose.linear().row(2) = forward.transpose();
  pose.linear().row(1) = forward.cross(right.normalized()).transpose();
  pose.translation() = -pose.linear() * eye;
  return pose;
}

}  // namespace sheen::app
