// SPDX-License-Identifier: MIT
#include "pipeline/evidence/corner_evidence.h"

#include "capture/pose/board_tags.h"
#include "core/alignment/projection_derivative.h"
#include "core/numerics/median.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostCornerViews = 12;
constexpr std::size_t kFewestCorners = 12, kPoseCorners = 4;
constexpr int kFewestNumbers = 600;  // below it a pattern of three unknowns fits noise
// Chosen on bench/stress with seed 1 and the recordings named in docs/stability-sessions.md: what a
// pattern must explain, RMS of the corners; less does no harm that is seen.
constexpr double kLens_px = 0.5, kBend_px = 0.3, kShutter_px = 0.3, kPrincipal_px = 0.5;
constexpr double kPatternShare = 0.35;
// Tags all round the object have .2 to .5, eight to one side of it 3. Sharp edges are 1.5 px wide,
// those of a quick walk with a video camera 2.1, a blur of 1 px makes 2.75.
constexpr double kLongLever = 1.2, kBlurred_px = 2.4;

constexpr double kStep = 1e-4;  // of a numerical derivative
constexpr int kCameraUnknowns = 5;

core::CameraModel with_change(const core::CameraModel& camera, int unknown) {
  auto changed = camera.intrinsics();
  if (unknown == 0) changed.focal_px *= 1 + kStep;
  if (unknown == 1) changed.distortion[0] += kStep;
  if (unknown == 2) changed.distortion[1] += kStep;
  if (unknown == 3) changed.principal_px.x() += kStep;
  if (unknown == 4) changed.principal_px.y() += kStep;
  return core::CameraModel(changed);
}

/// Of the values that are known.
std::optional<double> median_of(const std::vector<CornerEvidence::View>& views,
                                std::optional<double> CornerEvidence::View::*value) {
  std::vector<double> known;
  for (const CornerEvidence::View& view : views) {
    if (view.*value) known.push_back(*(view.*value));
  }
  if (known.empty()) return std::nullopt;
  return core::upper_median(known);
}

}  // namespace

CornerEvidence::CornerEvidence(const capture::Board& board, const core::CameraModel& camera,
                               std::vector<Eigen::Vector3d> object_in_board, std::size_t spacing)
    : board_(board),
      camera_(camera),
      changed_{with_change(camera, 0), with_change(camera, 1), with_change(camera, 2),
               with_change(camera, 3), with_change(camera, 4)},
      middle_(Eigen::Vector3d::Zero()),
      object_in_board_(std::move(object_in_board)),
      tracker_(board, camera, capture::BoardTagFinder(board, camera).family()),
      views_(kMostCornerViews, spacing) {
  Eigen::AlignedBox3d box;
  for (const auto& [id, tag] : board.tags) {
    for (const Eigen::Vector3d& corner : tag.corners_in_board()) box.extend(corner);
  }
  middle_ = box.center();
  extent_m_ = box.sizes().maxCoeff() / 2;
}

void CornerEvidence::look_at(const capture::Frame& frame,
                             const Eigen::Isometry3d& camera_from_board,
                             const std::optional<Eigen::Isometry3d>& last) {
  if (!views_.is_due()) return;
  View view;
  const auto pose = tracker_.track(capture::grey_of(frame), camera_from_board);
  const auto& corners = tracker_.corners();
  if (!pose) {
    views_.add(view);
    return;
  }
  view.blur_px = pose->blur_px;

  // How each corner moves with the pose and with each fault.
  const auto rows = static_cast<Eigen::Index>(2 * corners.size());
  Eigen::MatrixXd by_pose = Eigen::MatrixXd::Zero(rows, 6);
  Eigen::MatrixXd by_fault = Eigen::MatrixXd::Zero(rows, kUnknowns);
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(rows);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    const Eigen::Vector3d in_board =
        board_.tags.at(corners[i].tag_id)
            .corners_in_board()[static_cast<std::size_t>(corners[i].corner)];
    const Eigen::Vector3d in_camera = pose->camera_from_board * in_board;
    const auto seen = core::project_with_derivative(camera_, in_camera);
    if (!seen) continue;
    residual.segment<2>(row) = corners[i].residual_px;
    by_pose.middleRows<2>(row) = core::pixel_by_twist(seen->pixel_by_point, in_camera);
    for (int unknown = 0; unknown < kCameraUnknowns; ++unknown) {
      const auto moved = changed_[static_cast<std::size_t>(unknown)].project(in_camera);
      if (moved) by_fault.block<2, 1>(row, unknown) = (*moved - seen->pixel) / kStep;
    }
    const Eigen::Vector3d on_board = (in_board - middle_) / extent_m_;
    const Eigen::Vector2d by_rise =
        seen->pixel_by_point * pose->camera_from_board.linear() * Eigen::Vector3d::UnitZ();
    by_fault.block<2, 1>(row, kBend) = by_rise * on_board.x() * on_board.x();
    by_fault.block<2, 1>(row, kBend + 1) = by_rise * on_board.x() * on_board.y();
    by_fault.block<2, 1>(row, kBend + 2) = by_rise * on_board.y() * on_board.y();
    const auto before = last ? camera_.project(*last * in_board) : std::nullopt;
    if (before) {
      by_fault.block<2, 1>(row, kShutter) =
          (seen->pixel - *before) * (seen->pixel.y() / camera_.height_px() - 0.5);
    }
  }

  if (corners.size() >= kPoseCorners) {
    view.leverage = leverage_of(by_pose, pose->camera_from_board);
  }
  if (corners.size() < kFewestCorners) {
    views_.add(view);
    return;
  }

  // Take out what a pose can take up.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(by_pose);
  const auto off_pose = [&](const Eigen::MatrixXd& columns) -> Eigen::MatrixXd {
    Eigen::MatrixXd turned = qr.householderQ().transpose() * columns;
    return turned.bottomRows(rows - 6);
  };
  const Eigen::MatrixXd faults = off_pose(by_fault);
  const Eigen::VectorXd left = off_pose(residual);
  view.H = faults.transpose() * faults;
  view.g = faults.transpose() * left;
  view.squares_px2 = left.squaredNorm();
  view.numbers = static_cast<int>(rows - 6);
  views_.add(view);
}

/// By the covariance of the pose, one pixel squared for each coordinate of a corner.
double CornerEvidence::leverage_of(const Eigen::MatrixXd& by_pose,
                                   const Eigen::Isometry3d& camera_from_board) const {
  const Eigen::Matrix<double, 6, 6> information = by_pose.transpose() * by_pose;
  const auto solver = information.ldlt();
  double squares = 0;
  int points = 0;
  for (const Eigen::Vector3d& in_board : object_in_board_) {
    const Eigen::Vector3d in_camera = camera_from_board * in_board;
    const auto seen = core::project_with_derivative(camera_, in_camera);
    if (!seen) continue;
    const auto by_twist = core::pixel_by_twist(seen->pixel_by_point, in_camera);
    squares += (by_twist * solver.solve(by_twist.transpose())).trace();
    ++points;
  }
  return points > 0 ? std::sqrt(squares / points) : 0;
}

std::optional<double> CornerEvidence::leverage() const {
  return median_of(views_.items(), &View::leverage);
}

std::optional<double> CornerEvidence::blur_px() const {
  return median_of(views_.items(), &View::blur_px);
}

std::vector<Finding> CornerEvidence::weaknesses() const {
  std::vector<Finding> findings;
  if (const auto lever = leverage(); lever && *lever > kLongLever) {
    findings.push_back(
        {"tags-aside",
         fmt::format("the tags that are seen lie to one side of the object: what their corners are "
                     "off moves it in the image by {:.0f} times as much; put tags all round it, "
                     "or keep more of them in the images",
                     *lever)});
  }
  if (const auto blur = blur_px(); blur && *blur > kBlurred_px) {
    findings.push_back(
        {"blur", fmt::format("the images are blurred: the tags' edges are {:.1f} px wide, sharp "
                             "ones 1.5; focus on the object, move slowly, or give more light",
                             *blur)});
  }
  return findings;
}

CornerEvidence::Pattern CornerEvidence::fit(int first, int count) const {
  Matrix H = Matrix::Zero();
  Vector g = Vector::Zero();
  double squares = 0;
  int numbers = 0;
  for (const View& view : views_.items()) {
    H += view.H;
    g += view.g;
    squares += view.squares_px2;
    numbers += view.numbers;
  }
  Pattern pattern;
  if (numbers < kFewestNumbers || !(squares > 0)) return pattern;
  const Eigen::MatrixXd block = H.block(first, first, count, count);
  if (!(block.trace() > 0)) return pattern;
  const Eigen::VectorXd solution =
      block.completeOrthogonalDecomposition().solve(g.segment(first, count));
  const double explained = std::clamp(g.segment(first, count).dot(solution), 0.0, squares);
  pattern.solution.segment(first, count) = solution;
  pattern.effect_px = std::sqrt(2 * explained / numbers);  // of a corner: two numbers each
  pattern.share = explained / squares;
  return pattern;
}

std::vector<Finding> CornerEvidence::findings() const {
  const Pattern lens = fit(kLens, 3), bend = fit(kBend, 3), shutter = fit(kShutter, 1);
  const Pattern principal = fit(kPrincipal, 2);
  const double most_px =
      std::max({lens.effect_px, bend.effect_px, shutter.effect_px, principal.effect_px});
  const auto is_seen = [&](const Pattern& pattern, double least_px) {
    return pattern.effect_px >= most_px && pattern.effect_px > least_px &&
           pattern.share > kPatternShare;
  };
  const auto explained = [](const Pattern& pattern) {
    return fmt::format("{:.0f} % of what the tags' corners are off ({:.1f} px)",
                       100 * pattern.share, pattern.effect_px);
  };
  if (is_seen(lens, kLens_px)) {
    return {{"lens",
             fmt::format("the lens is not that of the camera file: a focal length {:+.1f} % and "
                         "other distortion explain {}; calibrate this camera at this focus and "
                         "image size (sheen calibrate)",
                         100 * lens.solution[kLens], explained(lens))}};
  }
  if (is_seen(principal, kPrincipal_px)) {
    return {{"lens",
             fmt::format("the lens is not that of the camera file: a principal point {:+.0f} px "
                         "to the right and {:+.0f} px down explains {}; calibrate this camera at "
                         "this image size, uncropped (sheen calibrate)",
                         principal.solution[kPrincipal], principal.solution[kPrincipal + 1],
                         explained(principal))}};
  }
  if (is_seen(bend, kBend_px)) {
    return {
        {"bent-board",
         fmt::format(
             "the board is not as flat, or as bent, as board.yaml says: a bend of at least {:.0f} "
             "mm explains {}; glue it to something stiff, or measure it (sheen survey)",
             1000 * bend.solution.segment<3>(kBend).cwiseAbs().maxCoeff(), explained(bend))}};
  }
  if (is_seen(shutter, kShutter_px)) {
    return {{"rolling-shutter",
             fmt::format("the camera reads its rows one after the other: {:.0f} % of the time "
                         "between frames explain {}; move more slowly, or state how long a frame "
                         "takes: readout_ms in camera.yaml (sheen replay measures it where it can)",
                         100 * std::abs(shutter.solution[kShutter]), explained(shutter))}};
  }
  return {};
}

}  // namespace sheen::pipeline
