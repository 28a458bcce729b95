// SPDX-License-Identifier: MIT
#include "capture/pose/tag_places.h"

#include "capture/pose/joint_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>

namespace sheen::capture {
namespace {

constexpr double kMostRms_px = 2;  // that of the gate of poses
constexpr std::size_t kFewestTags = 2;
constexpr double kNearlyAllTags = 0.97;  // of the tags seen; noise that decodes is rarer

bool lies_in_place(const Board::Tag& tag, const core::CameraModel& camera,
                   const Eigen::Isometry3d& camera_from_board, const TagDetection& seen) {
  const auto corners = tag.corners_in_board();
  double off_px = 0, side_px = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto stated = camera.project(camera_from_board * corners[c]);
    if (!stated) return false;
    off_px += (*stated - seen.corners_px[c]).norm() / 4;
    side_px += (seen.corners_px[(c + 1) % 4] - seen.corners_px[c]).norm() / 4;
  }
  return off_px < 0.5 * side_px;
}

/// The smallest and the largest id.
struct IdRange {
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  void take(int id) {
    first = std::min(first, id);
    last = std::max(last, id);
  }
};

}  // namespace

TagPlaces place_tags(const Board& board, const core::CameraModel& camera,
                     const std::vector<std::vector<TagDetection>>& views, int shift) {
  TagPlaces places;
  for (const auto& view : views) {
    std::vector<TagDetection> known;
    for (TagDetection tag : view) {
      ++places.seen;
      tag.id -= shift;
      if (board.tags.contains(tag.id)) {
        known.push_back(tag);
      } else {
        ++places.unknown[tag.id + shift];
      }
    }
    places.known += static_cast<int>(known.size());
    const auto pose = estimate_joint_pose(board, camera, known);
    if (!pose || pose->rms_px > kMostRms_px || pose->tag_ids.size() < kFewestTags) continue;
    for (const TagDetection& tag : known) {
      const bool is_in_place =
          lies_in_place(board.tags.at(tag.id), camera, pose->camera_from_board, tag);
      places.in_place += is_in_place ? 1 : 0;
      ++(is_in_place ? places.of_tag[tag.id].in_place : places.of_tag[tag.id].elsewhere);
    }
  }
  return places;
}

std::optional<IdFault> shifted_ids(const Board& board, const core::CameraModel& camera,
                                   const std::vector<std::vector<TagDetection>>& views) {
  const TagPlaces as_stated = place_tags(board, camera, views);
  if (as_stated.in_place >= kNearlyAllTags * as_stated.known) return std::nullopt;

  // Try every number under which the board holds nearly all of them.
  IdRange printed, stated;
  std::set<int> ids;
  for (const auto& view : views) {
    for (const TagDetection& tag : view) {
      printed.take(tag.id);
      ids.insert(tag.id);
    }
  }
  for (const auto& [id, tag] : board.tags) stated.take(id);
  for (int shift = printed.first - stated.last; shift <= printed.last - stated.first; ++shift) {
    const auto held = std::count_if(ids.begin(), ids.end(),
                                    [&](int id) { return board.tags.contains(id - shift); });
    if (shift == 0 ||
        static_cast<double>(held) < kNearlyAllTags * static_cast<double>(ids.size())) {
      continue;
    }
    const TagPlaces shifted = place_tags(board, camera, views, shift);
    if (shifted.in_place < kNearlyAllTags * shifted.seen) continue;
    const char* const too = shift < 0 ? "high" : "low";
    return IdFault{
        fmt::format(
            "its ids are {} too {} for the print: of {} tags seen {} lie where it says, and "
            "{} with its ids changed by {:+}",
            std::abs(shift), too, as_stated.seen, as_stated.in_place, shifted.in_place, shift),
        "give the board.yaml of this print, or correct its ids"};
  }
  return std::nullopt;
}

}  // namespace sheen::capture
