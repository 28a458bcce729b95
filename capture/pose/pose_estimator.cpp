// SPDX-License-Identifier: MIT
#include "capture/pose/pose_estimator.h"

#include "capture/pose/blur.h"
#include "capture/pose/board_tags.h"
#include "capture/pose/joint_pose.h"
#include "capture/pose/motion_prediction.h"
#include "capture/pose/tag_tracker.h"

#include <cassert>
#include <cmath>
#include <stdexcept>

namespace sheen::capture {
namespace {

constexpr double kRollingSlack = 5;  // corners of a fast pan are 10 px off a single pose

/// Follows the tags from frame to frame; searches the whole image where that fails.
class TagPoseEstimator : public PoseEstimator {
 public:
  TagPoseEstimator(const Board& board, const core::CameraModel& camera, const PoseGate& gate)
      : board_(board),
        camera_(camera),
        gate_(gate),
        finder_(board, camera),
        tracker_(board, camera, finder_.family()),
        slack_(camera.intrinsics().readout_s == 0 ? 1 : kRollingSlack) {
    gate_.check();
  }

  PoseResult estimate(const Frame& frame) override {
    const cv::Mat& grey = finder_.look_at(frame);

    // Follow the tags from where they should be by now.
    for (const auto& predicted : {motion_.predict(frame), motion_.last()}) {
      const auto pose =
          predicted ? tracker_.track(grey, *predicted, expected_readout()) : std::nullopt;
      if (pose && is_trusted(*pose)) return accept(frame, *pose);
    }

    // Else find them anywhere; their edges then say more than their corners.
    const PoseResult detected = detect(grey);
    const auto* start = std::get_if<FramePose>(&detected);
    if (start == nullptr) return detected;
    const auto pose = tracker_.track(grey, start->camera_from_board, expected_readout());
    if (pose && pose->tags >= start->tags && pose->reprojection_px <= gate_.max_reprojection_px) {
      return accept(frame, *pose);
    }
    if (start->reprojection_px > gate_.max_reprojection_px) return PoseRejection::reprojection;
    note(frame, *start);
    return detected;
  }

 private:
  PoseResult detect(const cv::Mat& grey) {
    // Find the board's tags.
    const std::vector<TagDetection> tags = finder_.find();
    if (tags.empty()) return PoseRejection::no_tags;
    if (static_cast<int>(tags.size()) < gate_.min_tags) return PoseRejection::too_few_tags;

    // Refuse smeared images before their corners are believed.
    const double blur_px =
        tag_edge_width(grey, camera_, finder_.family().modules, tags).value_or(0);
    if (blur_px > gate_.max_blur_px) return PoseRejection::blur;

    // Solve for the pose and refuse one that does not explain the corners.
    const auto pose = estimate_joint_pose(board_, camera_, tags);
    if (!pose || pose->rms_px > slack_ * gate_.max_reprojection_px) {
      return PoseRejection::reprojection;
    }
    const int used = static_cast<int>(pose->tag_ids.size());
    if (used < gate_.min_tags) return PoseRejection::too_few_tags;
    return FramePose{pose->camera_from_board, Twist::Zero(), used, pose->rms_px, blur_px};
  }

  /// Nothing of a global shutter.
  [[nodiscard]] std::optional<ExpectedReadout> expected_readout() const {
    constexpr double steady_px = 1, unknown_px = 5;
    const double readout_s = camera_.intrinsics().readout_s;
    if (readout_s == 0) return std::nullopt;
    const auto velocity = motion_.velocity();
    if (!velocity) return ExpectedReadout{Twist::Zero(), unknown_px};
    return ExpectedReadout{readout_s * *velocity, steady_px};
  }

  /// Half of the tags lost at once may mean that the rest was mistaken for others.
  [[nodiscard]] bool is_trusted(const TrackedPose& pose) const {
    return pose.tags >= gate_.min_tags && 2 * pose.tags >= last_tags_ &&
           pose.reprojection_px <= gate_.max_reprojection_px;
  }

  PoseResult accept(const Frame& frame, const TrackedPose& tracked) {
    const FramePose pose{tracked.camera_from_board, tracked.readout_motion, tracked.tags,
                         tracked.reprojection_px, tracked.blur_px};
    note(frame, pose);
    if (pose.blur_px > gate_.max_blur_px) return PoseRejection::blur;
    return pose;
  }

  void note(const Frame& frame, const FramePose& pose) {
    motion_.note(frame, pose.camera_from_board);
    last_tags_ = pose.tags;
  }

  Board board_;
  core::CameraModel camera_;
  PoseGate gate_;
  BoardTagFinder finder_;
  TagTracker tracker_;
  MotionPrediction motion_;
  double slack_;  ///< of the gate before the motion during the readout is known
  int last_tags_ = 0;
};

class RecordedPoseEstimator : public PoseEstimator {
 public:
  RecordedPoseEstimator(Trajectory trajectory, double fps, double readout_s)
      : trajectory_(std::move(trajectory)), fps_(fps), readout_s_(readout_s) {
    assert(fps > 0);
  }

  PoseResult estimate(const Frame& frame) override {
    const auto board_from_camera = trajectory_.board_from_camera(frame, fps_);
    if (!board_from_camera) return PoseRejection::no_pose_in_file;
    const auto velocity = readout_s_ != 0 ? trajectory_.velocity(frame, fps_) : std::nullopt;
    const Twist motion = velocity ? Twist(readout_s_ * *velocity) : Twist::Zero();
    return FramePose{board_from_camera->inverse(), motion, 0, 0, 0};
  }

 private:
  Trajectory trajectory_;
  double fps_;
  double readout_s_;
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

std::unique_ptr<PoseEstimator> make_recorded_pose_estimator(Trajectory trajectory, double fps,
                                                            double readout_s) {
  return std::make_unique<RecordedPoseEstimator>(std::move(trajectory), fps, readout_s);
}

}  // namespace sheen::capture
