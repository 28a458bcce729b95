// SPDX-License-Identifier: MIT
// The pose of a frame of 1280x720: following the tags against searching the whole image.
#include "capture/pose/board_tags.h"
#include "capture/pose/joint_pose.h"
#include "capture/pose/pose_estimator.h"
#include "capture/pose/tag_pattern.h"
#include "capture/pose/tag_tracker.h"

#include <benchmark/benchmark.h>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace sheen::capture {
namespace {

constexpr double kTag_m = 0.045;
constexpr double kPitch_m = 0.058;
constexpr int kFrames = 16;

core::CameraModel make_camera() {
  core::CameraModel::Intrinsics lens;
  lens.width_px = 1280;
  lens.height_px = 720;
  lens.focal_px = {1011, 1005};
  lens.principal_px = {648, 352};
  lens.distortion = {-0.12, 0.05, 0.0008, -0.0006, -0.01, 0, 0, 0};
  return core::CameraModel(lens);
}

Board make_board(int columns, int rows) {
  Board board;
  board.family = "tag36h11";
  for (int id = 0; id < columns * rows; ++id) {
    Board::Tag tag;
    tag.size_m = kTag_m;
    tag.board_from_tag.translation() << (id % columns - (columns - 1) / 2.0) * kPitch_m,
        ((rows - 1) / 2.0 - id / columns) * kPitch_m, 0;
    board.tags[id] = tag;
  }
  return board;
}

/// The board seen from above, 8 px a millimetre, softened as a lens does.
class Print {
 public:
  explicit Print(const Board& board)
      : image_(cv::Size(kSide_px, kSide_px), CV_8U, cv::Scalar(215)) {
    const TagFamily family = *find_tag_family(board.family, 1);
    for (const auto& [id, pattern] : find_tag_patterns(family, board)) {
      const Board::Tag& tag = board.tags.at(id);
      fill(tag, Eigen::Vector2d::Zero(), 1, kInk);
      for (const TagPattern::Cell& bit : pattern.bits) {
        if (bit.is_white) fill(tag, bit.centre, 1.0 / family.modules, kPaper);
      }
    }
    cv::GaussianBlur(image_, image_, {}, 3);
  }

  [[nodiscard]] const cv::Mat& image() const { return image_; }
  /// Pixel (0, 0) is the centre of the first pixel.
  static cv::Point2f px(double x_m, double y_m) {
    return {static_cast<float>(kSide_px / 2.0 - 0.5 + kPx_per_m * x_m),
            static_cast<float>(kSide_px / 2.0 - 0.5 - kPx_per_m * y_m)};
  }

 private:
  static constexpr int kSide_px = 5000;
  static constexpr double kPx_per_m = 8000;
  static constexpr double kInk = 40;
  static constexpr double kPaper = 215;

  /// A square of the tag, its centre and side in sides of the tag.
  void fill(const Board::Tag& tag, const Eigen::Vector2d& centre, double side, double value) {
    const Eigen::Vector3d& at = tag.board_from_tag.translation();
    const Eigen::Vector2d middle = at.head<2>() + tag.size_m * centre;
    const double half_m = tag.size_m * side / 2;
    const cv::Point2f upper_left = px(middle.x() - half_m, middle.y() + half_m);
    const auto side_px = static_cast<int>(std::lround(2 * half_m * kPx_per_m));
    image_(cv::Rect(cvCeil(upper_left.x), cvCeil(upper_left.y), side_px, side_px)) = value;
  }

  cv::Mat image_;
};

/// A hand-held camera that swings to and fro: 16 frames that may be repeated for ever.
class Recording {
 public:
  Recording(int columns, int rows) : board_(make_board(columns, rows)), camera_(make_camera()) {
    const Print print(board_);
    const std::vector<Eigen::Vector3d> rays = unproject_pixels();
    cv::RNG random(1);
    for (int i = 0; i < kFrames; ++i) {
      truth_.push_back(pose_at(i));
      Frame frame;
      cv::Mat grey = photograph(print, rays, truth_.back());
      cv::Mat noise(grey.size(), CV_8S);
      random.fill(noise, cv::RNG::NORMAL, 0, 3);
      cv::add(grey, noise, grey, cv::noArray(), CV_8U);
      cv::cvtColor(grey, frame.image, cv::COLOR_GRAY2BGR);
      frames_.push_back(frame);
    }
  }

  [[nodiscard]] const Board& board() const { return board_; }
  [[nodiscard]] const core::CameraModel& camera() const { return camera_; }
  [[nodiscard]] Frame frame(int i) const {
    Frame frame = frames_[static_cast<std::size_t>(i % kFrames)];
    frame.index = i;
    frame.time_s = i / 30.0;
    return frame;
  }
  [[nodiscard]] const Eigen::Isometry3d& truth(int i) const {
    return truth_[static_cast<std::size_t>(i % kFrames)];
  }

 private:
  static Eigen::Isometry3d pose_at(int i) {
    const double swing = std::sin(2 * std::numbers::pi * i / kFrames);
    const double azimuth = 0.7 + 0.1 * swing;
    const double elevation = 0.95 + 0.03 * swing;
    const Eigen::Vector3d eye =
        0.55 * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                               std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    const Eigen::Vector3d forward = -eye.normalized();
    const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
    Eigen::Isometry3d board_from_camera = Eigen::Isometry3d::Identity();
    board_from_camera.linear() << right, forward.cross(right), forward;
    board_from_camera.translation() = eye;
    return board_from_camera.inverse();
  }

  [[nodiscard]] std::vector<Eigen::Vector3d> unproject_pixels() const {
    std::vector<Eigen::Vector3d> rays;
    for (int y = 0; y < camera_.height_px(); ++y) {
      for (int x = 0; x < camera_.width_px(); ++x) rays.push_back(*camera_.unproject({x, y}));
    }
    return rays;
  }

  [[nodiscard]] cv::Mat photograph(const Print& print, const std::vector<Eigen::Vector3d>& rays,
                                   const Eigen::Isometry3d& camera_from_board) const {
    const Eigen::Isometry3d board_from_camera = camera_from_board.inverse();
    const Eigen::Vector3d& eye = board_from_camera.translation();
    cv::Mat place(camera_.height_px(), camera_.width_px(), CV_32FC2);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Eigen::Vector3d ray = board_from_camera.linear() * rays[i];
      const Eigen::Vector3d p = eye - eye.z() / ray.z() * ray;
      place.at<cv::Point2f>(static_cast<int>(i)) = Print::px(p.x(), p.y());
    }
    cv::Mat grey;
    cv::remap(print.image(), grey, place, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT,
              cv::Scalar(120));
    return grey;
  }

  Board board_;
  core::CameraModel camera_;
  std::vector<Frame> frames_;
  std::vector<Eigen::Isometry3d> truth_;
};

const Recording& recording(const benchmark::State& state) {
  static const Recording with_24(6, 4);
  static const Recording with_40(8, 5);
  return state.range(0) == 24 ? with_24 : with_40;
}

double position_error_mm(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  return 1e3 * (estimate.inverse().translation() - truth.inverse().translation()).norm();
}

/// BGR -> pose, the tags followed.
void track(benchmark::State& state) {
  const Recording& seen = recording(state);
  const auto estimator = make_tag_pose_estimator(seen.board(), seen.camera(), {});
  // Let the motion be known: the first frames are searched.
  int i = 0;
  for (; i < kFrames; ++i) (void)estimator->estimate(seen.frame(i));
  double worst_mm = 0;
  double tags = 0;
  for (auto _ : state) {
    const PoseResult result = estimator->estimate(seen.frame(i));
    const auto& pose = std::get<FramePose>(result);
    worst_mm = std::max(worst_mm, position_error_mm(pose.camera_from_board, seen.truth(i)));
    tags += pose.tags;
    ++i;
  }
  state.counters["worst_mm"] = worst_mm;
  state.counters["tags"] = tags / static_cast<double>(state.iterations());
}

/// The tracker alone: the grey image is there.
void track_grey(benchmark::State& state) {
  const Recording& seen = recording(state);
  TagTracker tracker(seen.board(), seen.camera(), *find_tag_family("tag36h11", 1));
  std::vector<cv::Mat> grey(kFrames);
  for (int i = 0; i < kFrames; ++i) {
    cv::cvtColor(seen.frame(i).image, grey[static_cast<std::size_t>(i)], cv::COLOR_BGR2GRAY);
  }
  double square_px = 0;
  double corners = 0;
  for (int i = 1; auto _ : state) {
    // The pose of the frame before: a prediction 5 to 40 px off.
    const auto pose = tracker.track(grey[static_cast<std::size_t>(i % kFrames)], seen.truth(i - 1));
    if (!pose) state.SkipWithError("lost");
    for (const MeasuredCorner& corner : tracker.corners()) {
      const auto at = static_cast<std::size_t>(corner.corner);
      const auto& tag = seen.board().tags.at(corner.tag_id);
      const auto truth = seen.camera().project(seen.truth(i) * tag.corners_in_board()[at]);
      square_px += (corner.px - *truth).squaredNorm();
      ++corners;
    }
    ++i;
  }
  state.counters["corner_rms_px"] = std::sqrt(square_px / corners);
}

void make_grey(benchmark::State& state) {
  const Recording& seen = recording(state);
  cv::Mat grey;
  for (auto _ : state) {
    cv::cvtColor(seen.frame(0).image, grey, cv::COLOR_BGR2GRAY);
    benchmark::DoNotOptimize(grey.data);
  }
}

/// libapriltag alone on the grey image: images of this size are decimated by 2.
void detect_only(benchmark::State& state) {
  const Recording& seen = recording(state);
  const TagDetector detector(*find_tag_family("tag36h11", 1));
  cv::Mat grey;
  cv::cvtColor(seen.frame(0).image, grey, cv::COLOR_BGR2GRAY);
  for (auto _ : state) benchmark::DoNotOptimize(detector.detect(grey));
}

/// BGR -> pose by searching every image: detection, refined corners, joint pose.
void detect_and_solve(benchmark::State& state) {
  const Recording& seen = recording(state);
  BoardTagFinder finder(seen.board(), seen.camera());
  double worst_mm = 0;
  for (int i = 0; auto _ : state) {
    finder.look_at(seen.frame(i));
    const auto pose = estimate_joint_pose(seen.board(), seen.camera(), finder.find());
    worst_mm = std::max(worst_mm, position_error_mm(pose->camera_from_board, seen.truth(i)));
    ++i;
  }
  state.counters["worst_mm"] = worst_mm;
}

BENCHMARK(track)->Arg(24)->Arg(40)->Unit(benchmark::kMillisecond);
BENCHMARK(track_grey)->Arg(24)->Arg(40)->Unit(benchmark::kMillisecond);
BENCHMARK(make_grey)->Arg(24)->Unit(benchmark::kMillisecond);
BENCHMARK(detect_only)->Arg(24)->Arg(40)->Unit(benchmark::kMillisecond);
BENCHMARK(detect_and_solve)->Arg(24)->Arg(40)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sheen::capture
