// SPDX-License-Identifier: MIT
#include "pipeline/session_readout.h"

#include "capture/pose/rolling_shutter.h"
#include "core/alignment/projection_derivative.h"
#include "pipeline/evidence/corner_evidence.h"
#include "pipeline/session_parts.h"

#include <Eigen/QR>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sheen::pipeline {
namespace {

constexpr int kStretches = 3, kStretchFrames = 14;
constexpr int kMostFrames = 240;         // videos are decoded from their beginning
constexpr double kLongestStep_s = 0.15;  // between frames, to know how the camera moves
constexpr double kSteady_s = 1e-9;       // rows are read one after the other; nothing is expected
constexpr int kFewestFrames = 10;
// Of what the rows show beyond one pose: share explained by the camera's motion, its size.
constexpr double kLeastShare = 0.3, kLeastEffect_px = 0.1;
constexpr double kLeastUpright = 0.2;  // else the frames say little of their own
constexpr double kLeastCertainty = 4;  // standard deviations from zero

struct Posed {
  double time_s = 0;
  int index = 0;
  capture::FramePose pose;
};

/// Inner product of two motions by how they bend the board's image beyond what a pose takes up:
/// 6 x 6, px^2. `corners` counts those that are seen.
Eigen::Matrix<double, 6, 6> bending(const capture::Board& board, const core::CameraModel& camera,
                                    const Eigen::Isometry3d& camera_from_board, int& corners) {
  std::vector<Eigen::Matrix<double, 2, 6>> by_twist;
  std::vector<double> shares;
  for (const auto& [id, tag] : board.tags) {
    for (const Eigen::Vector3d& corner : tag.corners_in_board()) {
      const Eigen::Vector3d point = camera_from_board * corner;
      const auto seen = core::project_with_derivative(camera, point);
      const bool is_inside = seen && seen->pixel.minCoeff() >= 0 &&
                             seen->pixel.x() < camera.width_px() &&
                             seen->pixel.y() < camera.height_px();
      if (!is_inside) continue;
      by_twist.push_back(core::pixel_by_twist(seen->pixel_by_point, point));
      shares.push_back(capture::row_share(seen->pixel.y(), camera.height_px()));
    }
  }
  corners = static_cast<int>(by_twist.size());
  const auto rows = static_cast<Eigen::Index>(2 * by_twist.size());
  if (rows <= 12) return Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::MatrixXd by_pose(rows, 6), by_motion(rows, 6);
  for (std::size_t i = 0; i < by_twist.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    by_pose.middleRows<2>(row) = by_twist[i];
    by_motion.middleRows<2>(row) = shares[i] * by_twist[i];
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(by_pose);
  const Eigen::MatrixXd turned = qr.householderQ().transpose() * by_motion;
  const auto left = turned.bottomRows(rows - 6);
  return left.transpose() * left;
}

/// Sums of the regression of what the rows show on how the camera moves.
struct Regression {
  double moves = 0, mixed = 0, shows = 0;
  int frames = 0, corners = 0;

  void add(const Eigen::Matrix<double, 6, 6>& product, const capture::Twist& velocity,
           const capture::Twist& motion, int seen) {
    moves += velocity.dot(product * velocity);
    mixed += velocity.dot(product * motion);
    shows += motion.dot(product * motion);
    ++frames;
    corners += seen;
  }

  [[nodiscard]] std::optional<Readout> solve() const {
    if (frames < kFewestFrames || !(moves > 0) || !(shows > 0)) return std::nullopt;
    const double readout_s = mixed / moves;
    const double explained = readout_s * mixed;
    const double effect_px = std::sqrt(explained / corners);
    const double sigma_s = std::sqrt(std::max(shows - explained, 0.0) / frames / moves);
    const bool is_seen = explained > kLeastShare * shows && effect_px > kLeastEffect_px &&
                         std::abs(readout_s) > kLeastCertainty * sigma_s;
    if (!is_seen) return std::nullopt;
    return Readout{readout_s, sigma_s};
  }
};

/// Adds a stretch: each frame against how the camera moves between its neighbours.
void add_stretch(const std::vector<Posed>& posed, const capture::Board& board,
                 const core::CameraModel& camera, Regression& regression) {
  for (std::size_t i = 1; i + 1 < posed.size(); ++i) {
    const Posed &before = posed[i - 1], &after = posed[i + 1];
    const double time_s = after.time_s - before.time_s;
    const bool are_neighbours = after.index - before.index == 2;
    if (!are_neighbours || !(time_s > 0) || time_s > 2 * kLongestStep_s) continue;
    const capture::Twist velocity =
        capture::twist_between(before.pose.camera_from_board, after.pose.camera_from_board) /
        time_s;
    int corners = 0;
    const auto product = bending(board, camera, posed[i].pose.camera_from_board, corners);
    regression.add(product, velocity, posed[i].pose.readout_motion, corners);
  }
}

/// Reads the first `count` frames once; the motion that each shows leans towards what a readout of
/// `readout_s` makes expected.
Regression look_at_stretches(const capture::Session& session, const FrameChoice& choice,
                             const capture::Board& board, int count, double readout_s) {
  capture::Session rolling = session;
  auto intrinsics = session.camera.intrinsics();
  intrinsics.readout_s = readout_s;
  rolling.camera = core::CameraModel(intrinsics);
  const auto frames = capture::open_frames(session, choice.start, choice.start + count);
  Regression regression;
  for (int stretch = 0; stretch < kStretches; ++stretch) {
    const int first =
        choice.start + count * (2 * stretch + 1) / (2 * kStretches) - kStretchFrames / 2;
    const auto estimator = make_pose_estimator(rolling, choice.pose_source, choice.gate);
    std::vector<Posed> posed;
    while (const auto frame = frames->next()) {
      if (frame->index < first) continue;
      const auto result = estimator->estimate(*frame);
      if (const auto* pose = std::get_if<capture::FramePose>(&result)) {
        posed.push_back({frame->time_s, frame->index, *pose});
      }
      if (frame->index + 1 == first + kStretchFrames) break;
    }
    add_stretch(posed, board, session.camera, regression);
  }
  return regression;
}

/// A camera that moves steadily bends the tags as a wrong principal point or lens does, whose
/// patterns of the corners tell them apart.
bool is_rather_the_lens(const capture::Session& session, const FrameChoice& choice,
                        const capture::Board& board, int count) {
  CornerEvidence corners(board, session.camera, {});
  const auto estimator = make_pose_estimator(session, choice.pose_source, choice.gate);
  const auto frames = capture::open_frames(session, choice.start, choice.start + count);
  std::optional<Eigen::Isometry3d> last;
  while (const auto frame = frames->next()) {
    const auto result = estimator->estimate(*frame);
    const auto* const pose = std::get_if<capture::FramePose>(&result);
    if (pose != nullptr) corners.look_at(*frame, pose->camera_from_board, last);
    last = pose != nullptr ? std::optional(pose->camera_from_board) : std::nullopt;
  }
  const double shutter = corners.fit(CornerEvidence::kShutter, 1).share;
  return corners.fit(CornerEvidence::kPrincipal, 2).share > shutter ||
         corners.fit(CornerEvidence::kLens, 3).share > shutter;
}

}  // namespace

std::optional<Readout> measure_readout(const capture::Session& session, const FrameChoice& choice) {
  const auto board = tag_board(session, choice.pose_source);
  const bool has_times = session.video || session.fps || session.stamps;
  if (!board || !has_times) return std::nullopt;
  const auto all = capture::open_frames(session, choice.start, choice.end)->frame_count();
  const int count = std::min(all.value_or(0), kMostFrames);
  if (count < kStretches * kStretchFrames) return std::nullopt;
  // Each frame's motion leans towards what is expected of it. Expect nothing, then what that shows:
  // the slope follows by the share of the leaning, which both tell.
  const auto none = look_at_stretches(session, choice, *board, count, kSteady_s).solve();
  if (!none) return std::nullopt;
  const auto some = look_at_stretches(session, choice, *board, count, none->readout_s).solve();
  if (!some) return std::nullopt;
  const double upright = 2 - some->readout_s / none->readout_s;  // 1: nothing leans
  if (!(upright > kLeastUpright && upright <= 1.2)) return std::nullopt;
  if (is_rather_the_lens(session, choice, *board, count)) return std::nullopt;
  return Readout{none->readout_s / upright, some->sigma_s / upright};
}

void complete_readout(capture::Session& session, const FrameChoice& choice, ProgressSink& sink) {
  if (session.camera.intrinsics().readout_s != 0) return;
  const auto readout = measure_readout(session, choice);
  if (!readout) return;
  auto intrinsics = session.camera.intrinsics();
  intrinsics.readout_s = readout->readout_s;
  session.camera = core::CameraModel(intrinsics);
  sink.note(fmt::format(
      "{0}: the camera reads its rows one after the other, a frame in {1:.1f} +- {2:.1f} ms; poses "
      "and images are corrected for it (to know it from the start, live too: readout_ms: {1:.1f} "
      "in "
      "camera.yaml)",
      session.folder.string(), 1e3 * readout->readout_s, 1e3 * readout->sigma_s));
}

}  // namespace sheen::pipeline
