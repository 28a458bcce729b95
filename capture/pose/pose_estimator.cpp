// SPDX-License-Identifier: MIT
#include "capture/pose/pose_estimator.h"

#include "capture/pose/blur.h"
#include "capture/pose/corner_refinement.h"
#include "capture/pose/joint_pose.h"
#include "capture/pose/tag_detector.h"

#include <opencv2/imgproc.hpp>

#include <cassert>
#include <cmath>
#include <stdexcept>

namespace sheen::capture {
namespace {

TagFamily family_of(const Board& board) {
  const auto family = find_tag_family(board.family, board.border_bits);
  if (!family) throw std::invalid_argument("no detector knows the tag family " + board.family);
  return *family;
}

class TagPoseEstimator : public PoseEstimator {
 public:
  TagPoseEstimator(const Board& board, const core::CameraModel& camera, const PoseGate& gate)
      : board_(board), camera_(camera), gate_(gate), family_(family_of(board)), detector_(family_) {
    gate_.check();
  }

  PoseResult estimate(const Frame& frame) override {
    // Find the board's tags.
    cv::cvtColor(frame.image, grey_, cv::COLOR_BGR2GRAY);
    std::vector<TagDetection> tags = drop_ambiguous(detector_.detect(grey_));
    std::erase_if(tags, [&](const TagDetection& tag) { return !board_.tags.contains(tag.id); });
    if (tags.empty()) return PoseRejection::no_tags;
    if (static_cast<int>(tags.size()) < gate_.min_tags) return PoseRejection::too_few_tags;
    for (TagDetection& tag : tags) {
      refine_corners(grey_, camera_, family_.modules, tag.corners_px);
    }

    // Refuse smeared pictures before their corners are believed.
    const double blur_px = tag_edge_width(grey_, camera_, family_.modules, tags).value_or(0);
    if (blur_px > gate_.max_blur_px) return PoseRejection::blur;

    // Solve for the pose and refuse one that does not explain the corners.
    const auto pose = estimate_joint_pose(board_, camera_, tags);
    if (!pose || pose->rms_px > gate_.max_reprojection_px) return PoseRejection::reprojection;
    const int used = static_cast<int>(pose->tag_ids.size());
    if (used < gate_.min_tags) return PoseRejection::too_few_tags;
    return FramePose{pose->camera_from_stage, used, pose->rms_px, blur_px};
  }

 private:
  Board board_;
  core::CameraModel camera_;
  PoseGate gate_;
  TagFamily family_;
  TagDetector detector_;
  cv::Mat grey_;  // kept between frames to save its allocation
};

class RecordedPoseEstimator : public PoseEstimator {
 public:
  RecordedPoseEstimator(Trajectory trajectory, double fps)
      : trajectory_(std::move(trajectory)), fps_(fps) {
    assert(fps > 0);
  }

  PoseResult estimate(const Frame& frame) override {
    const auto stage_from_camera = trajectory_.stage_from_camera(frame, fps_);
    if (!stage_from_camera) return PoseRejection::no_pose_in_file;
    return FramePose{stage_from_camera->inverse(), 0, 0, 0};
  }

 private:
  Trajectory trajectory_;
  double fps_;
};

}  // namespace

std::string_view name_of(PoseRejection rejection) {
  switch (rejection) {
    case PoseRejection::no_tags:
      return "no_tags";
    case PoseRejection::too_few_tags:
      return "too_few_tags";
    case PoseRejection::reprojection:
      return "reprojection";
    case PoseRejection::blur:
      return "blur";
    case PoseRejection::no_pose_in_file:
      return "no_pose_in_file";
  }
  assert(false);
  return {};
}

void PoseGate::check() const {
  const auto is_positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (min_tags < 1) throw std::invalid_argument("min_tags must be at least 1");
  if (!is_positive(max_reprojection_px)) {
    throw std::invalid_argument("max_reprojection_px must be positive");
  }
  if (!is_positive(max_blur_px)) throw std::invalid_argument("max_blur_px must be positive");
}

std::unique_ptr<PoseEstimator> make_tag_pose_estimator(const Board& board,
                                                       const core::CameraModel& camera,
                                                       const PoseGate& gate) {
  return std::make_unique<TagPoseEstimator>(board, camera, gate);
}

std::unique_ptr<PoseEstimator> make_recorded_pose_estimator(Trajectory trajectory, double fps) {
  return std::make_unique<RecordedPoseEstimator>(std::move(trajectory), fps);
}

}  // namespace sheen::capture
