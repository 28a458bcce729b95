// SPDX-License-Identifier: MIT
#include "capture/pose/paper_light.h"

#include "core/image/bilinear.h"
#include "core/image/srgb_curve.h"
#include "core/numerics/median.h"

#include <opencv2/imgproc.hpp>

#include <array>
#include <cstddef>
#include <optional>

namespace sheen::capture {
namespace {

constexpr double kSeen = 0.7;      // correlation of its bits: as the tracker asks
constexpr double kDarkest = 0.02;  // linear light; below it noise and flare count
constexpr int kPointsPerSide = 8;
constexpr double kBeside = 0.5;  // of a module, outside the black square

/// Places around a tag's black square, half a module outside, in the board frame.
std::vector<Eigen::Vector3d> places_around(const BoardTag& tag) {
  const auto& corners = tag.corners_in_board;
  const Eigen::Vector3d centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
  const double grown = 1 + 2 * kBeside / tag.modules;
  std::vector<Eigen::Vector3d> places;
  for (std::size_t side = 0; side < 4; ++side) {
    const Eigen::Vector3d begin = centre + grown * (corners[side] - centre);
    const Eigen::Vector3d end = centre + grown * (corners[(side + 1) % 4] - centre);
    for (int i = 0; i < kPointsPerSide; ++i) {
      places.emplace_back(begin + (i + 0.5) / kPointsPerSide * (end - begin));
    }
  }
  return places;
}

/// The median of each channel, against a corner of the object or a finger.
std::optional<Eigen::Vector3d> median_light(const cv::Mat& image, const core::CameraModel& camera,
                                            const std::vector<Eigen::Vector3d>& in_camera) {
  std::array<std::vector<double>, 3> seen;
  for (const Eigen::Vector3d& place : in_camera) {
    const auto px = camera.project(place);
    const bool is_inside =
        px && px->minCoeff() >= 0 && px->x() < image.cols - 1 && px->y() < image.rows - 1;
    if (!is_inside) continue;
    const auto rgb = core::bilinear_rgb(image, px->cast<float>());
    for (std::size_t c = 0; c < 3; ++c) {
      seen[c].push_back(static_cast<double>(core::linear_from_srgb(rgb[c] / 255)));
    }
  }
  if (2 * seen[0].size() < in_camera.size()) return std::nullopt;
  Eigen::Vector3d light;
  for (std::size_t c = 0; c < 3; ++c) {
    light[static_cast<Eigen::Index>(c)] = core::upper_median(seen[c]);
  }
  if (!(light.minCoeff() > kDarkest)) return std::nullopt;
  return light;
}

}  // namespace

PaperReader::PaperReader(const Board& board, const core::CameraModel& camera) : camera_(camera) {
  const auto family = find_tag_family(board.family, board.border_bits);
  if (!family) return;
  for (auto& [id, pattern] : find_tag_patterns(*family, board)) {
    if (!pattern.is_black_inside) continue;
    tags_.push_back(
        {id, board.tags.at(id).corners_in_board(), family->modules, std::move(pattern)});
  }
}

std::vector<PaperLight> PaperReader::read(const cv::Mat& image,
                                          const Eigen::Isometry3d& camera_from_board) const {
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  std::vector<PaperLight> lights;
  for (const BoardTag& tag : tags_) {
    const auto view = TagView::find(tag, camera_, camera_from_board, Twist::Zero());
    if (!view || view->pattern_correlation(camera_, grey) < kSeen) continue;
    std::vector<Eigen::Vector3d> in_camera = places_around(tag);
    for (Eigen::Vector3d& place : in_camera) place = camera_from_board * place;
    if (const auto light = median_light(image, camera_, in_camera)) {
      lights.push_back({tag.id, *light});
    }
  }
  return lights;
}

}  // namespace sheen::capture
