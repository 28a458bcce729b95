// SPDX-License-Identifier: MIT
#include "capture/registration/contour.h"

#include "core/alignment/projection_derivative.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace sheen::capture {
namespace {

constexpr float kSharpCosine = 0.8f;  // faces turned by more than 37 degrees make a crease
constexpr double kProbePx = 1;        // distance of the two confirming rays from the contour
constexpr double kSameSurface = 0.3;  // of the radius: a grazed surface falls away fast
constexpr double kStepInDepth = 0.1;  // of the radius: less is a fold, not an edge of the object
constexpr double kBorderPx = 2;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One number for all vertices at one position: hard edges double their vertices.
std::vector<std::uint32_t> merge_by_position(const core::Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.positions.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto key = [&](std::uint32_t i) {
    const Eigen::Vector3f& p = mesh.positions[i];
    return std::tuple(p.x(), p.y(), p.z(), i);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> merged(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_same = i > 0 && mesh.positions[order[i]] == mesh.positions[order[i - 1]];
    merged[order[i]] = is_same ? merged[order[i - 1]] : order[i];
  }
  return merged;
}

/// Image of a point with the unit image of a direction at it.
struct ImagedDirection {
  Eigen::Vector2d pixel;
  Eigen::Vector2d direction;
};

std::optional<ImagedDirection> project_direction(const core::CameraModel& camera,
                                                 const Eigen::Isometry3d& camera_from_object,
                                                 const Eigen::Vector3d& point,
                                                 const Eigen::Vector3d& direction) {
  const auto projected = core::project_with_derivative(camera, camera_from_object * point);
  if (!projected) return std::nullopt;
  const Eigen::Vector2d image =
      projected->pixel_by_point * (camera_from_object.linear() * direction);
  if (!(image.norm() > 0)) return std::nullopt;
  return ImagedDirection{projected->pixel, image.normalized()};
}

}  // namespace

ContourFinder::ContourFinder(const core::Mesh& mesh) : mesh_(mesh), rays_(mesh) {
  const std::vector<std::uint32_t> merged = merge_by_position(mesh);
  struct Side {
    std::uint32_t low, high, face;
  };
  std::vector<Side> sides;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& triangle = mesh.triangles[f];
    const Eigen::Vector3f& a = mesh.positions[triangle[0]];
    const Eigen::Vector3f& b = mesh.positions[triangle[1]];
    const Eigen::Vector3f& c = mesh.positions[triangle[2]];
    faces_.push_back({(b - a).cross(c - a).normalized(), (a + b + c) / 3});
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = merged[triangle[i]];
      const std::uint32_t to = merged[triangle[(i + 1) % 3]];
      if (from != to) sides.push_back({std::min(from, to), std::max(from, to), f});
      bounds_.extend(mesh.positions[triangle[i]].cast<double>());
    }
  }
  radius_m_ = bounds_.diagonal().norm() / 2;

  // Pair the sides of neighbouring faces; a third face at an edge counts as a border.
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
  });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    Edge edge{{sides[i].low, sides[i].high}, {sides[i].face, kNoFace}};
    if (i + 1 < sides.size() && sides[i + 1].low == edge.vertices[0] &&
        sides[i + 1].high == edge.vertices[1]) {
      edge.faces[1] = sides[++i].face;
      edge.is_sharp = faces_[edge.faces[0]].normal.dot(faces_[edge.faces[1]].normal) < kSharpCosine;
    } else {
      edge.is_sharp = true;
    }
    edges_.push_back(edge);
  }
}

std::vector<bool> ContourFinder::faces_turned_to(const Eigen::Vector3f& eye) const {
  std::vector<bool> turned(faces_.size());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    turned[f] = faces_[f].normal.dot(eye - faces_[f].centre) > 0;
  }
  return turned;
}

std::optional<ContourFinder::EdgeImage> ContourFinder::image_of(
    const Edge& edge, const std::vector<bool>& turned_to_eye, const core::CameraModel& camera,
    const Eigen::Isometry3d& camera_from_object) const {
  const bool has_two = edge.faces[1] != kNoFace;
  if (has_two && turned_to_eye[edge.faces[0]] == turned_to_eye[edge.faces[1]]) return std::nullopt;
  EdgeImage image;
  image.begin = mesh_.positions[edge.vertices[0]].cast<double>();
  image.end = mesh_.positions[edge.vertices[1]].cast<double>();
  const auto first = camera.project(camera_from_object * image.begin);
  const auto last = camera.project(camera_from_object * image.end);
  if (!first || !last) return std::nullopt;
  image.length_px = (*last - *first).norm();
  if (!(image.length_px > 0)) return std::nullopt;
  image.normal = (mesh_.normals[edge.vertices[0]] + mesh_.normals[edge.vertices[1]]).cast<double>();

  // Across the edge, away from the nearer face.
  const std::uint32_t nearer =
      !has_two || turned_to_eye[edge.faces[0]] ? edge.faces[0] : edge.faces[1];
  const Eigen::Vector2d along = (*last - *first) / image.length_px;
  image.across = {-along.y(), along.x()};
  const auto centre = camera.project(camera_from_object * faces_[nearer].centre.cast<double>());
  if (centre && image.across.dot(*centre - *first) > 0) image.across = -image.across;
  return image;
}

std::vector<ContourPoint> ContourFinder::find(const core::CameraModel& camera,
                                              const Eigen::Isometry3d& camera_from_object,
                                              double spacing_px) const {
  const Eigen::Isometry3d object_from_camera = camera_from_object.inverse();
  const std::vector<bool> turned_to_eye =
      faces_turned_to(object_from_camera.translation().cast<float>());
  const Eigen::Array2d last_pixel(camera.width_px() - 1, camera.height_px() - 1);
  std::vector<ContourPoint> points;
  double walked_px = 0;  // since the last point; short edges share it
  for (const Edge& edge : edges_) {
    const auto image = image_of(edge, turned_to_eye, camera, camera_from_object);
    if (!image) continue;
    for (walked_px += image->length_px; walked_px >= spacing_px; walked_px -= spacing_px) {
      const double share = std::clamp((walked_px - spacing_px) / image->length_px, 0.0, 1.0);
      const Eigen::Vector3d p = share * image->begin + (1 - share) * image->end;
      // Outward is along the surface's normal; at a crease, across the edge.
      const auto imaged = project_direction(camera, camera_from_object, p, image->normal);
      if (!imaged) continue;
      const ContourPoint point{p, imaged->pixel, edge.is_sharp ? image->across : imaged->direction};
      const bool is_within = (point.pixel.array() >= kBorderPx).all() &&
                             (point.pixel.array() <= last_pixel - kBorderPx).all();
      if (is_within &&
          is_depth_step(camera, object_from_camera, point, (camera_from_object * p).z())) {
        points.push_back(point);
      }
    }
  }
  return points;
}

double ContourFinder::depth_at(const core::CameraModel& camera,
                               const Eigen::Isometry3d& object_from_camera,
                               const Eigen::Vector2d& pixel) const {
  const auto ray = camera.unproject(pixel);
  if (!ray) return kInfinity;
  const Eigen::Vector3f direction = (object_from_camera.linear() * *ray).cast<float>();
  const auto hit = rays_.first_hit(object_from_camera.translation().cast<float>(), direction, 0,
                                   std::numeric_limits<float>::infinity());
  return hit ? static_cast<double>(hit->distance) : kInfinity;
}

bool ContourFinder::is_depth_step(const core::CameraModel& camera,
                                  const Eigen::Isometry3d& object_from_camera,
                                  const ContourPoint& point, double depth_m) const {
  const double inside =
      depth_at(camera, object_from_camera, point.pixel - kProbePx * point.outward);
  if (!(std::abs(inside - depth_m) < kSameSurface * radius_m_)) return false;
  const double outside =
      depth_at(camera, object_from_camera, point.pixel + kProbePx * point.outward);
  return outside > depth_m + kStepInDepth * radius_m_;
}

bool ContourFinder::meets(const Eigen::Isometry3d& object_from_camera,
                          const Eigen::Vector3d& ray) const {
  const Eigen::Vector3f direction = (object_from_camera.linear() * ray).cast<float>();
  return rays_
      .first_hit(object_from_camera.translation().cast<float>(), direction, 0,
                 std::numeric_limits<float>::infinity())
      .has_value();
}

}  // namespace sheen::capture
