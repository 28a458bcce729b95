// SPDX-License-Identifier: MIT
#include "capture/pose/tag_pattern.h"

#include "capture/pose/apriltag_family.h"

#include <opencv2/aruco.hpp>

#include <cstdint>

namespace sheen::capture {
namespace {

/// Centre of a module counted from the square's upper left.
Eigen::Vector2d module_centre(int column, int row, int modules) {
  return {(column + 0.5) / modules - 0.5, 0.5 - (row + 0.5) / modules};
}

TagPattern apriltag_pattern(const apriltag_family_t& codes, int id) {
  TagPattern pattern;
  pattern.is_black_inside = !codes.reversed_border;
  const std::uint64_t code = codes.codes[id];
  for (std::uint32_t i = 0; i < codes.nbits; ++i) {
    const bool is_white = (code >> (codes.nbits - 1 - i) & 1U) != 0;
    pattern.bits.push_back({module_centre(static_cast<int>(codes.bit_x[i]),
                                          static_cast<int>(codes.bit_y[i]), codes.width_at_border),
                            is_white});
  }
  return pattern;
}

TagPattern aruco_pattern(const TagFamily& family, const cv::aruco::Dictionary& codes, int id) {
  const int border = (family.modules - codes.markerSize) / 2;
  cv::Mat print;
  codes.drawMarker(id, family.modules, print, border);
  if (family.half_turn) cv::rotate(print, print, cv::ROTATE_180);
  TagPattern pattern;
  for (int row = border; row < family.modules - border; ++row) {
    for (int column = border; column < family.modules - border; ++column) {
      pattern.bits.push_back(
          {module_centre(column, row, family.modules), print.at<unsigned char>(row, column) != 0});
    }
  }
  return pattern;
}

}  // namespace

std::map<int, TagPattern> find_tag_patterns(const TagFamily& family, const Board& board) {
  const int count = code_count(family);
  std::map<int, TagPattern> patterns;
  if (family.library == TagFamily::Library::aruco) {
    const auto codes = cv::aruco::getPredefinedDictionary(family.aruco_dictionary_id);
    for (const auto& [id, tag] : board.tags) {
      if (id >= 0 && id < count) patterns[id] = aruco_pattern(family, *codes, id);
    }
    return patterns;
  }
  const auto codes = AprilTagFamily::find(family.name);
  for (const auto& [id, tag] : board.tags) {
    if (id >= 0 && id < count) patterns[id] = apriltag_pattern(*codes->get(), id);
  }
  return patterns;
}

}  // namespace sheen::capture
