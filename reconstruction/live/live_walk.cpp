// SPDX-License-Identifier: MIT
#include "reconstruction/live/live_walk.h"

#include "capture/board_print/default_board.h"
#include "capture/pose/joint_pose.h"
#include "capture/walk_calibration/walk_calibration.h"
#include "reconstruction/stage/print_check.h"

#include <utility>

namespace sheen::reconstruction {
namespace {

constexpr double kLook_s = 0.12;    // from look to look: a third of a core at 1280x720
constexpr int kViewWidth_px = 240;  // of images that are kept
constexpr int kFirstFrames = 20;    // must not show another board
constexpr std::size_t kFewestTags = 2;
constexpr double kMostMiss_px = 6;  // RMS of the corners; a guessed lens misses, too

Eigen::Vector3d middle_of(const capture::Board& board) {
  const Eigen::Vector2d middle = tags_region(board).center().cast<double>();
  return {middle.x(), middle.y(), 0};
}

}  // namespace

LiveWalk::LiveWalk(WalkStart start)
    : start_(std::move(start)), calibrate_at_(capture::kFewestWalkViews) {
  sight_.camera = start_.camera;
  if (start_.board) sight_.middle = middle_of(*start_.board);
  list_missing();  // all of them
  finder_.emplace(start_.board ? *start_.board : capture::all_default_tags(), start_.camera);
}

void LiveWalk::look_at(const capture::Frame& frame) {
  if (frame.time_s < next_look_s_) return;
  next_look_s_ = frame.time_s + kLook_s;
  if (!start_.board) recognise_board(frame);
  std::optional<capture::JointPose> pose;
  if (start_.board) {
    finder_->look_at(frame);
    auto tags = finder_->find();
    if (tags.size() >= kFewestTags) {
      pose = capture::estimate_joint_pose(*start_.board, start_.camera, tags);
    }
    if (pose && pose->rms_px > kMostMiss_px) pose.reset();
    if (pose) keep(frame, pose->camera_from_board, std::move(tags));
    if (start_.camera_is_guessed && seen_ >= calibrate_at_) calibrate();
  }
  const std::lock_guard lock(mutex_);
  ++sight_.frames;
  sight_.image = frame.image.clone();
  sight_.camera_from_board.reset();
  if (pose) sight_.camera_from_board = pose->camera_from_board;
  list_missing();
}

void LiveWalk::list_missing() {
  sight_.missing.clear();
  for (std::size_t i = 0; i < kViewDirections; ++i) {
    if (!kept_[i]) sight_.missing.push_back(i);
  }
}

void LiveWalk::recognise_board(const capture::Frame& frame) {
  finder_->look_at(frame);
  const auto tags = finder_->find();
  const auto sheet = capture::recognise_default_sheet(tags);
  if (!sheet) {
    if (sight_.frames < kFirstFrames) {
      capture::refuse_other_board(start_.session, start_.camera, frame);
    }
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    start_.board = capture::default_board(*sheet);
    sight_.middle = middle_of(*start_.board);
  }
  finder_.emplace(*start_.board, start_.camera);
}

void LiveWalk::keep(const capture::Frame& frame, const Eigen::Isometry3d& camera_from_board,
                    std::vector<capture::TagDetection> tags) {
  const Eigen::Vector3d towards_eye =
      camera_from_board.inverse().translation() - middle_of(*start_.board);
  const auto direction = view_direction_of(towards_eye);
  if (!direction) return;
  const double closeness = towards_eye.normalized().dot(middle_of_direction(*direction));
  std::optional<KeptView>& kept = kept_[*direction];
  if (kept && kept->closeness >= closeness) return;
  const int factor = reduction(start_.camera.width_px(), kViewWidth_px);
  KeptView view{std::move(tags),
                {frame.index, reduced(frame.image, factor).clone(), camera_from_board},
                closeness};
  const std::lock_guard lock(mutex_);
  seen_ += kept ? 0 : 1;
  kept = std::move(view);
}

void LiveWalk::calibrate() {
  calibrate_at_ = seen_ + (seen_ + 1) / 2;
  std::vector<std::vector<capture::TagDetection>> tags;
  for (const auto& kept : kept_) {
    if (kept) tags.push_back(kept->tags);
  }
  const capture::ImageSize size{start_.camera.width_px(), start_.camera.height_px()};
  const auto found = capture::calibrate_from_walk(*start_.board, capture::guessed_lens(size), tags);
  if (found && capture::find_fault(*found).empty()) use(found->camera);
}

void LiveWalk::use(const core::CameraModel& camera) {
  finder_.emplace(*start_.board, camera);
  const std::lock_guard lock(mutex_);
  start_.camera = camera;
  sight_.camera = camera;
  ++lenses_;
  for (auto& kept : kept_) {
    if (!kept) continue;
    const auto pose = capture::estimate_joint_pose(*start_.board, camera, kept->tags);
    if (pose) kept->view.camera_from_board = pose->camera_from_board;
  }
}

WalkSight LiveWalk::sight() const {
  const std::lock_guard lock(mutex_);
  return sight_;
}

std::optional<WalkViews> LiveWalk::views() const {
  const std::lock_guard lock(mutex_);
  if (!start_.board) return std::nullopt;
  WalkViews views{*start_.board,
                  reduced(start_.camera, reduction(start_.camera.width_px(), kViewWidth_px)),
                  {},
                  lenses_};
  for (const auto& kept : kept_) {
    if (kept) views.views.push_back(kept->view);
  }
  return views;
}

}  // namespace sheen::reconstruction
