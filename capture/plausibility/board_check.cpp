// SPDX-License-Identifier: MIT
#include "capture/plausibility/board_check.h"

#include "capture/plausibility/unit_guess.h"
#include "core/diagnostics/error.h"
#include "core/numerics/median.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace sheen::capture {
namespace {

// sheen board prints tags of 5 to 250 mm; building sites use larger, microscopes smaller ones.
constexpr double kSmallestPrint_m = 0.004, kLargestPrint_m = 0.3;
constexpr double kSmallestTag_m = 0.0005, kLargestTag_m = 5;
constexpr double kWidestPitch = 60;  // distance of neighbours over their size
constexpr double kNarrowGap = 0.06;  // over the size: Kalibr's boards have 0.3
constexpr std::size_t kMostCompared = 500;

/// A tag and the nearest other one of about its size in its plane.
struct Neighbours {
  int id = 0;
  double size_m = 0;
  double distance_m = std::numeric_limits<double>::infinity();
};

bool are_alike(const Board::Tag& a, const Board::Tag& b) {
  const double larger = std::max(a.size_m, b.size_m);
  const Eigen::Vector3d between = b.board_from_tag.translation() - a.board_from_tag.translation();
  const Eigen::Vector3d normal = a.board_from_tag.linear().col(2);
  return std::min(a.size_m, b.size_m) > 0.5 * larger &&
         normal.dot(b.board_from_tag.linear().col(2)) > 0.98 &&
         std::abs(normal.dot(between)) < 0.2 * larger;
}

/// Of at most kMostCompared tags, spread over all.
std::vector<Neighbours> nearest_neighbours(const Board& board) {
  std::vector<Neighbours> nearest;
  const std::size_t stride = std::max<std::size_t>(1, board.tags.size() / kMostCompared);
  std::size_t count = 0;
  for (const auto& [id, tag] : board.tags) {
    if (count++ % stride != 0) continue;
    Neighbours found{id, tag.size_m};
    for (const auto& [other_id, other] : board.tags) {
      if (other_id == id || !are_alike(tag, other)) continue;
      found.distance_m =
          std::min(found.distance_m,
                   (other.board_from_tag.translation() - tag.board_from_tag.translation()).norm());
    }
    if (std::isfinite(found.distance_m)) nearest.push_back(found);
  }
  return nearest;
}

/// The one in the middle by distance over size.
Neighbours typical(std::vector<Neighbours> neighbours) {
  const auto middle = neighbours.begin() + static_cast<std::ptrdiff_t>(neighbours.size() / 2);
  std::nth_element(neighbours.begin(), middle, neighbours.end(),
                   [](const Neighbours& a, const Neighbours& b) {
                     return a.distance_m * b.size_m < b.distance_m * a.size_m;
                   });
  return *middle;
}

}  // namespace

double typical_tag_m(const Board& board) {
  std::vector<double> sizes;
  for (const auto& [id, tag] : board.tags) sizes.push_back(tag.size_m);
  return sizes.empty() ? 0 : core::upper_median(sizes);
}

double board_extent_m(const Board& board) {
  Eigen::AlignedBox3d box;
  for (const auto& [id, tag] : board.tags) {
    for (const Eigen::Vector3d& corner : tag.corners_in_board()) box.extend(corner);
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

std::vector<std::string> check_tag_layout(const Board& board, const std::filesystem::path& path) {
  const std::vector<Neighbours> all = nearest_neighbours(board);
  std::vector<std::string> doubts;
  if (all.empty()) return doubts;
  const Neighbours middle = typical(all);
  const double pitch = middle.distance_m / middle.size_m;
  const std::string tag =
      fmt::format("tag {} is {} wide and its nearest neighbour {} away", middle.id,
                  length_text(middle.size_m), length_text(middle.distance_m));
  if (pitch > kWidestPitch) {
    throw core::bad_input(path, tag,
                          unit_question(middle.distance_m, 1.02 * middle.size_m, 20 * middle.size_m,
                                        "size and x, y, z must be metres") +
                              " (x, y, z)");
  }
  if (pitch < 0.9) {
    throw core::bad_input(
        path, tag + ", so that they overlap",
        unit_question(middle.size_m, 0.05 * middle.distance_m, 0.98 * middle.distance_m,
                      "size is the side of the black square, x and y its centre") +
            " (size)");
  }
  if (pitch < 1) {
    doubts.push_back(tag + ", so that they overlap; size is the side of the black square");
  }
  if (board.border_bits > 1 && pitch >= 1 && pitch < 1 + kNarrowGap) {
    doubts.push_back(fmt::format(
        "gaps of {:.2g} mm between tags of {:.3g} mm are narrow; tagSpacing is the gap divided by "
        "tagSize",
        1000 * (middle.distance_m - middle.size_m), 1000 * middle.size_m));
  }
  return doubts;
}

std::vector<std::string> check_tag_size(const Board& board, const std::filesystem::path& path) {
  const double size_m = typical_tag_m(board);
  const std::string fault = fmt::format("a tag is {} wide", length_text(size_m));
  const std::string question = unit_question(size_m, kSmallestPrint_m, kLargestPrint_m,
                                             "size must be the side of the black square in metres");
  if (size_m > kLargestTag_m || size_m < kSmallestTag_m) {
    throw core::bad_input(path, fault, question);
  }
  std::vector<std::string> doubts;
  if (size_m > 4 * kLargestPrint_m || size_m < kSmallestPrint_m / 4) {
    doubts.push_back(fault + "; " + question);
  }
  return doubts;
}

std::vector<std::string> check_board(const Board& board, const std::filesystem::path& path) {
  std::vector<std::string> doubts = check_tag_layout(board, path);
  for (std::string& doubt : check_tag_size(board, path)) doubts.push_back(std::move(doubt));
  return doubts;
}

}  // namespace sheen::capture
