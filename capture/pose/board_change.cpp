// SPDX-License-Identifier: MIT
#include "capture/pose/board_change.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace sheen::capture {
namespace {

constexpr double kSidePx = 760;
constexpr int kMarginPx = 40;
constexpr int kLegendPx = 44;
const cv::Scalar kPaper(250, 250, 250);
const cv::Scalar kInk(60, 55, 50);
const cv::Scalar kBefore(200, 200, 200);
const cv::Scalar kLevel(200, 120, 40);
const cv::Scalar kHigher(50, 60, 210);
const cv::Scalar kLower(70, 150, 40);

/// Board metres -> pixels, y up on the board.
struct Map {
  Eigen::Vector2d corner_m;  ///< lower left
  double scale = 1;
  double height_px = 0;

  [[nodiscard]] cv::Point2d at(const Eigen::Vector3d& p) const {
    return {kMarginPx + (p.x() - corner_m.x()) * scale,
            height_px - kMarginPx - (p.y() - corner_m.y()) * scale};
  }
};

cv::Point subpixel(const cv::Point2d& p) {
  return {cvRound(p.x * 16), cvRound(p.y * 16)};  // 4 fractional bits
}

void draw_tag(cv::Mat& image, const Map& map, const Board::Tag& tag, const cv::Scalar& colour,
              bool filled) {
  std::vector<cv::Point> outline;
  for (const Eigen::Vector3d& corner : tag.corners_in_board()) {
    outline.push_back(subpixel(map.at(corner)));
  }
  if (filled) {
    cv::fillConvexPoly(image, outline, colour, cv::LINE_AA, 4);
  } else {
    cv::polylines(image, outline, true, colour, 1, cv::LINE_AA, 4);
  }
}

/// Full colour at the largest height, that of a level tag at none.
cv::Scalar colour_of(double height_m, double largest_m) {
  const double share = largest_m > 0 ? std::min(1.0, std::abs(height_m) / largest_m) : 0;
  return (1 - share) * kLevel + share * (height_m > 0 ? kHigher : kLower);
}

/// A round factor that makes the largest shift about half a tag long.
double magnification(double largest_m, double tag_m) {
  if (!(largest_m > 0)) return 1;
  const double wanted = 0.6 * tag_m / largest_m;
  const double power = std::pow(10, std::floor(std::log10(std::max(wanted, 1.0))));
  for (const double step : {5.0, 2.0}) {
    if (wanted >= step * power) return step * power;
  }
  return power;
}

/// What decides the scales of the drawing.
struct Extent {
  Eigen::AlignedBox2d box;
  double tag_m = 0;     ///< side of the largest tag
  double shift_m = 0;   ///< largest, in the plane
  double height_m = 0;  ///< largest, either way
};

Extent measure(const Board& board) {
  Extent extent;
  for (const auto& [id, tag] : board.tags) {
    for (const Eigen::Vector3d& corner : tag.corners_in_board()) {
      extent.box.extend(corner.head<2>());
    }
    extent.tag_m = std::max(extent.tag_m, tag.size_m);
  }
  return extent;
}

void draw_shift(cv::Mat& image, const Map& map, const Board::Tag& tag, const TagChange& change,
                double factor, double highest_m) {
  const Eigen::Vector3d from = tag.board_from_tag.translation();
  cv::arrowedLine(image, map.at(from), map.at(from + factor * change.shift_m),
                  colour_of(change.shift_m.z(), highest_m), 2, cv::LINE_AA, 0, 0.2);
  cv::putText(image, fmt::format("{} {:+.2f}", change.id, 1e3 * change.shift_m.z()),
              map.at(tag.corners_in_board()[0]) + cv::Point2d(3, -4), cv::FONT_HERSHEY_SIMPLEX,
              0.38, kInk, 1, cv::LINE_AA);
}

void write_line(cv::Mat& image, int above_foot_px, const std::string& text) {
  cv::putText(image, text, {kMarginPx, image.rows - above_foot_px}, cv::FONT_HERSHEY_SIMPLEX, 0.45,
              kInk, 1, cv::LINE_AA);
}

}  // namespace

std::vector<TagChange> compare_boards(const Board& before, const Board& after) {
  std::vector<TagChange> changes;
  for (const auto& [id, tag] : before.tags) {
    const auto other = after.tags.find(id);
    if (other == after.tags.end()) continue;
    const Eigen::Isometry3d& a = tag.board_from_tag;
    const Eigen::Isometry3d& b = other->second.board_from_tag;
    const double cosine = a.linear().col(2).dot(b.linear().col(2));
    changes.push_back(
        {id, b.translation() - a.translation(), std::acos(std::clamp(cosine, -1.0, 1.0))});
  }
  return changes;
}

cv::Mat draw_board_change(const Board& before, const Board& after) {
  const std::vector<TagChange> changes = compare_boards(before, after);
  Extent extent = measure(before);
  for (const TagChange& change : changes) {
    extent.shift_m = std::max(extent.shift_m, change.shift_m.head<2>().norm());
    extent.height_m = std::max(extent.height_m, std::abs(change.shift_m.z()));
  }
  const double scale = kSidePx / std::max(extent.box.sizes().maxCoeff(), 1e-6);
  const Eigen::Vector2d size_px =
      extent.box.sizes() * scale + Eigen::Vector2d::Constant(2 * kMarginPx);
  const Map map{extent.box.min(), scale, size_px.y()};
  cv::Mat image(static_cast<int>(size_px.y()) + kLegendPx,
                std::max(static_cast<int>(size_px.x()), 420), CV_8UC3, kPaper);

  const double factor = magnification(extent.shift_m, extent.tag_m);
  for (const TagChange& change : changes) {
    draw_tag(image, map, before.tags.at(change.id), kBefore, true);
    draw_tag(image, map, after.tags.at(change.id), colour_of(change.shift_m.z(), extent.height_m),
             false);
  }
  for (const TagChange& change : changes) {
    draw_shift(image, map, before.tags.at(change.id), change, factor, extent.height_m);
  }
  write_line(image, 34,
             fmt::format("arrows {:g} x: largest {:.2f} mm; numbers: tag, height in mm", factor,
                         1e3 * extent.shift_m));
  write_line(image, 14, "red: higher, green: lower");
  return image;
}

}  // namespace sheen::capture
