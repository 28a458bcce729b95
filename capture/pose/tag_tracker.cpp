// SPDX-License-Identifier: MIT
#include "capture/pose/tag_tracker.h"

#include "capture/pose/side_line.h"
#include "core/numerics/median.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sheen::capture {
namespace {

double tag_rms_px(std::vector<MeasuredCorner>::const_iterator first,
                  std::vector<MeasuredCorner>::const_iterator last) {
  double sum = 0;
  for (auto corner = first; corner != last; ++corner) sum += corner->residual_px.squaredNorm();
  return std::sqrt(sum / static_cast<double>(last - first));
}

}  // namespace

TagTracker::TagTracker(const Board& board, const core::CameraModel& camera, const TagFamily& family)
    : camera_(camera), search_(camera) {
  for (auto& [id, pattern] : find_tag_patterns(family, board)) {
    tags_.push_back({id, board.tags.at(id).corners_in_board(), family.modules, std::move(pattern)});
  }
}

std::optional<TrackedPose> TagTracker::track(const cv::Mat& grey,
                                             const Eigen::Isometry3d& predicted,
                                             const std::optional<ExpectedReadout>& expected) {
  constexpr double min_correlation = 0.7;  // a wrong code of tag36h11 reaches 0.4
  if (grey.cols != camera_.width_px() || grey.rows != camera_.height_px()) return std::nullopt;

  // Come near, and keep the tags whose codes are where they should be.
  State state{predicted, expected ? expected->motion : Twist(Twist::Zero())};
  if (!approach(grey, expected, state)) return std::nullopt;
  look(state);
  std::erase_if(views_, [&](const TagView& view) {
    return view.pattern_correlation(camera_, grey) < min_correlation;
  });

  // Align with their edges.
  const auto blur_px = search_.measure_widths(grey, views_);
  if (!blur_px || !align(grey, expected, state)) return std::nullopt;

  // Say how well their corners fit.
  measure_corners(state);
  TrackedPose pose{state.camera_from_board, state.readout_motion, drop_misfits(), 0, *blur_px};
  if (corners_.empty()) return std::nullopt;
  pose.reprojection_px = tag_rms_px(corners_.begin(), corners_.end());
  return pose;
}

std::optional<TagView> TagTracker::view_of(const BoardTag& tag, const State& state) const {
  return TagView::find(tag, camera_, state.camera_from_board, state.readout_motion);
}

void TagTracker::look(const State& state) {
  views_.clear();
  for (const BoardTag& tag : tags_) {
    if (const auto view = view_of(tag, state)) views_.push_back(*view);
  }
}

void TagTracker::look_again(const State& state) {
  for (TagView& view : views_) {
    if (const auto moved_view = view_of(view.tag(), state)) view = *moved_view;
  }
}

bool TagTracker::approach(const cv::Mat& grey, const std::optional<ExpectedReadout>& expected,
                          State& state) {
  constexpr std::array<double, 4> reach_modules{1.6, 1.0, 0.6, 0.6};
  constexpr double scale_px = 0.5;  // steps are found to about a third of a pixel
  constexpr double near_px = 0.6;
  for (const double reach : reach_modules) {
    look(state);
    search_.find_steps(grey, views_, reach);
    const auto alignment = improve(scale_px, expected, state);
    if (!alignment) return false;
    if (alignment->moved_px < near_px) return true;
  }
  return false;
}

bool TagTracker::align(const cv::Mat& grey, const std::optional<ExpectedReadout>& expected,
                       State& state) {
  constexpr int max_rounds = 4;
  constexpr double scale_px = 0.1;    // positions of a clean edge scatter by less
  constexpr double settled_px = 0.1;  // profiles are centred: another round would change nothing
  for (int round = 0; round < max_rounds; ++round) {
    look_again(state);
    search_.find_sides(grey, views_);
    const auto alignment = improve(scale_px, expected, state);
    if (!alignment) return false;
    if (alignment->moved_px < settled_px) return true;
  }
  return false;
}

/// Aligns with the edges that were found last.
std::optional<EdgeAlignment> TagTracker::improve(double scale_px,
                                                 const std::optional<ExpectedReadout>& expected,
                                                 State& state) {
  const auto prior = expected ? std::optional(prior_of(*expected, state)) : std::nullopt;
  const auto alignment = align_edges(search_.observations(), scale_px, room_, prior);
  if (!alignment) return std::nullopt;
  state.camera_from_board = moved(state.camera_from_board, alignment->twist);
  state.readout_motion += alignment->readout_motion;
  return alignment;
}

/// A turn and a shift that move the image alike cost alike.
ReadoutMotionPrior TagTracker::prior_of(const ExpectedReadout& expected, const State& state) const {
  constexpr double edge_px = 0.1;  // what an edge that was found scatters by
  const double focal_px = camera_.intrinsics().focal_px.mean();
  const double distance_m = state.camera_from_board.translation().norm();
  const double turn = focal_px * edge_px / expected.deviation_px;
  const double shift = turn / distance_m;
  ReadoutMotionPrior prior;
  prior.mean = expected.motion - state.readout_motion;
  prior.precision << Eigen::Vector3d::Constant(turn * turn),
      Eigen::Vector3d::Constant(shift * shift);
  return prior;
}

void TagTracker::measure_corners(const State& state) {
  // Let the sides of each tag meet, against where it was when they were measured.
  corners_.clear();
  const auto& sides = search_.sides();
  for (std::size_t i = 0; i < sides.size();) {
    const std::size_t view = sides[i].view;
    std::array<const EdgeSearch::Side*, 4> found{};
    for (; i < sides.size() && sides[i].view == view; ++i) found[sides[i].side] = &sides[i];
    const TagView& seen = views_[view];
    const auto fitted = view_of(seen.tag(), state);
    if (!fitted) continue;
    for (std::size_t c = 0; c < 4; ++c) {
      const EdgeSearch::Side* before = found[(c + 3) % 4];
      const EdgeSearch::Side* after = found[c];
      if (before == nullptr || after == nullptr) continue;
      const auto offset = meeting_point(before->outward[1], before->offset.at_end,
                                        after->outward[0], after->offset.at_begin);
      if (!offset) continue;
      const Eigen::Vector2d px = seen.corners_px()[c] + *offset;
      corners_.push_back({seen.tag().id, static_cast<int>(c), px, px - fitted->corners_px()[c]});
    }
  }
}

int TagTracker::drop_misfits() {
  // The rule of the joint pose over detected corners: tags far above the rest go, at most a third.
  constexpr double far_above = 4;
  constexpr double always_fine_px = 0.8;
  const auto end_of_tag = [&](auto first) {
    return std::find_if(first, corners_.end(), [&](const MeasuredCorner& corner) {
      return corner.tag_id != first->tag_id;
    });
  };
  room_.clear();
  for (auto first = corners_.begin(); first != corners_.end(); first = end_of_tag(first)) {
    room_.push_back(tag_rms_px(first, end_of_tag(first)));
  }
  if (room_.empty()) return 0;
  std::sort(room_.begin(), room_.end());
  const double worst_kept = room_[room_.size() - 1 - room_.size() / 3];
  const double limit = std::max({always_fine_px, far_above * room_[room_.size() / 2], worst_kept});
  int kept_tags = 0;
  auto kept = corners_.begin();
  for (auto first = corners_.begin(); first != corners_.end();) {
    const auto last = end_of_tag(first);
    if (tag_rms_px(first, last) <= limit) {
      kept = std::copy(first, last, kept);
      ++kept_tags;
    }
    first = last;
  }
  corners_.erase(kept, corners_.end());
  return kept_tags;
}

}  // namespace sheen::capture
