// SPDX-License-Identifier: MIT
#include "capture/pose/tag_view.h"

#include "capture/pose/rolling_shutter.h"
#include "core/alignment/projection_derivative.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace sheen::capture {
namespace {

constexpr double kSmallestModule_px = 2;  // below it neighbouring edges melt into each other

bool overlaps_image(const std::array<Eigen::Vector2d, 4>& corners_px,
                    const core::CameraModel& camera) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : corners_px) box.extend(corner);
  const Eigen::AlignedBox2d image(Eigen::Vector2d::Zero(),
                                  Eigen::Vector2d(camera.width_px() - 1, camera.height_px() - 1));
  return image.intersects(box);
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Bilinear read-out; no value outside the image.
std::optional<double> brightness(const cv::Mat& grey, const Eigen::Vector2d& px) {
  const bool is_inside =
      px.x() >= 0 && px.y() >= 0 && px.x() < grey.cols - 1 && px.y() < grey.rows - 1;
  if (!is_inside) return std::nullopt;
  const int x = static_cast<int>(px.x());
  const int y = static_cast<int>(px.y());
  const double fx = px.x() - x;
  const double fy = px.y() - y;
  const auto* upper = grey.ptr<unsigned char>(y) + x;
  const auto* lower = grey.ptr<unsigned char>(y + 1) + x;
  return (1 - fy) * ((1 - fx) * upper[0] + fx * upper[1]) +
         fy * ((1 - fx) * lower[0] + fx * lower[1]);
}

}  // namespace

std::optional<TagView> TagView::find(const BoardTag& tag, const core::CameraModel& camera,
                                     const Eigen::Isometry3d& camera_from_board,
                                     const Twist& readout_motion) {
  // Place the corners.
  TagView view;
  view.tag_ = &tag;
  for (std::size_t c = 0; c < 4; ++c) {
    view.corners_in_camera_[c] =
        when_its_row_is_read(camera, readout_motion, camera_from_board * tag.corners_in_board[c]);
    const auto px = camera.project(view.corners_in_camera_[c]);
    if (!px) return std::nullopt;
    view.corners_px_[c] = *px;
  }
  if (!overlaps_image(view.corners_px_, camera)) return std::nullopt;

  // Measure its modules; a tag seen from behind has negative ones.
  const auto& corners = view.corners_px_;
  const Eigen::Vector2d centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
  for (std::size_t s = 0; s < 4; ++s) {
    const Eigen::Vector2d along = (corners[(s + 1) % 4] - corners[s]).normalized();
    const double distance = cross(along, centre - corners[s]);
    view.module_px_[s] = -2 * distance / tag.modules;
    if (!(view.module_px_[s] >= kSmallestModule_px)) return std::nullopt;
  }
  return view;
}

double TagView::side_px(std::size_t side) const {
  return (corners_px_[(side + 1) % 4] - corners_px_[side]).norm();
}

std::optional<EdgePoint> TagView::edge(const core::CameraModel& camera, std::size_t side,
                                       double t) const {
  const Eigen::Vector3d along = corners_in_camera_[(side + 1) % 4] - corners_in_camera_[side];
  const Eigen::Vector3d point = corners_in_camera_[side] + t * along;
  const auto projected = core::project_with_derivative(camera, point);
  if (!projected) return std::nullopt;
  // Corners run counter-clockwise on the print; y points down in the image.
  const Eigen::Vector2d tangent = projected->pixel_by_point * along;
  const Eigen::Vector2d outward = Eigen::Vector2d(-tangent.y(), tangent.x()).normalized();
  const Eigen::Vector3d outward_by_point = projected->pixel_by_point.transpose() * outward;
  EdgePoint edge{projected->pixel, outward, {}};
  edge.outward_by_twist << point.cross(outward_by_point), outward_by_point;
  return edge;
}

std::optional<Eigen::Vector2d> TagView::point_px(const core::CameraModel& camera, std::size_t side,
                                                 double t) const {
  const Eigen::Vector3d& begin = corners_in_camera_[side];
  return camera.project(begin + t * (corners_in_camera_[(side + 1) % 4] - begin));
}

double TagView::pattern_correlation(const core::CameraModel& camera, const cv::Mat& grey) const {
  const Eigen::Vector3d right = corners_in_camera_[1] - corners_in_camera_[0];
  const Eigen::Vector3d up = corners_in_camera_[3] - corners_in_camera_[0];
  const Eigen::Vector3d centre = corners_in_camera_[0] + (right + up) / 2;
  double n = 0;
  double sum_code = 0;
  double sum = 0;
  double sum_squares = 0;
  double sum_mixed = 0;
  for (const TagPattern::Cell& bit : tag_->pattern.bits) {
    const auto px = camera.project(centre + bit.centre.x() * right + bit.centre.y() * up);
    const auto value = px ? brightness(grey, *px) : std::nullopt;
    if (!value) continue;
    const double code = bit.is_white ? 1 : -1;
    n += 1;
    sum_code += code;
    sum += *value;
    sum_squares += *value * *value;
    sum_mixed += code * *value;
  }
  if (4 * n < 3 * static_cast<double>(tag_->pattern.bits.size())) return -1;
  constexpr double min_deviation = 6;  // of 255: flat patches show no code
  const double variance = sum_squares / n - (sum / n) * (sum / n);
  const double code_variance = 1 - (sum_code / n) * (sum_code / n);
  if (!(variance > min_deviation * min_deviation) || !(code_variance > 0)) return -1;
  return (sum_mixed / n - sum_code / n * sum / n) / std::sqrt(variance * code_variance);
}

}  // namespace sheen::capture
