// SPDX-License-Identifier: MIT
#include "capture/dataset/board_alignment.h"

#include "capture/pose/pose_estimator.h"
#include "capture/source/still_reader.h"
#include "core/diagnostics/error.h"
#include "core/numerics/median.h"

#include <Eigen/SVD>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sheen::capture {
namespace {

constexpr std::size_t kFewestPairs = 3;
constexpr double kFarOff = 3;              // in medians of the distances between the two places
constexpr double kLeastMotion = 1e-9;      // of the cameras, in units
constexpr double kMostDisagreement = 0.1;  // of the spread of the cameras

[[noreturn]] void refuse_alignment(const std::filesystem::path& path, const std::string& fault) {
  throw core::bad_input(path, fault,
                        "give the board that the images show, or --scale or --known-distance");
}

/// The rotation that is nearest to all of the pairs'.
Eigen::Matrix3d mean_turn(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) {
    sum += pair.board_from_camera.linear() * pair.world_from_camera.linear().transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1, (parts.matrixU() * parts.matrixV().transpose()).determinant());
  return parts.matrixU() * signs.asDiagonal() * parts.matrixV().transpose();
}

/// Distance between the two places of a camera, metres.
double error_of(const BoardAlignment& alignment, const PosePair& pair) {
  const Eigen::Vector3d place = alignment.board_from_world *
                                (alignment.metres_per_unit * pair.world_from_camera.translation());
  return (place - pair.board_from_camera.translation()).norm();
}

BoardAlignment fitted(const std::vector<PosePair>& pairs, const std::filesystem::path& path) {
  Eigen::Vector3d world_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d board_mean = Eigen::Vector3d::Zero();
  const auto count = static_cast<double>(pairs.size());
  for (const PosePair& pair : pairs) {
    world_mean += pair.world_from_camera.translation() / count;
    board_mean += pair.board_from_camera.translation() / count;
  }
  BoardAlignment alignment{.images = pairs.size()};
  alignment.board_from_world.linear() = mean_turn(pairs);
  double along = 0;
  double world_squared = 0;
  double board_squared = 0;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d world =
        alignment.board_from_world.linear() * (pair.world_from_camera.translation() - world_mean);
    const Eigen::Vector3d board = pair.board_from_camera.translation() - board_mean;
    along += world.dot(board);
    world_squared += world.squaredNorm();
    board_squared += board.squaredNorm();
  }
  if (!(world_squared > count * kLeastMotion * kLeastMotion)) {
    refuse_alignment(path, "shows tags from one place only: no scale follows");
  }
  alignment.metres_per_unit = along / world_squared;
  alignment.board_from_world.translation() =
      board_mean - alignment.metres_per_unit * (alignment.board_from_world.linear() * world_mean);
  double squared = 0;
  for (const PosePair& pair : pairs) squared += std::pow(error_of(alignment, pair), 2);
  alignment.rms_m = std::sqrt(squared / count);
  const bool agree = squared < kMostDisagreement * kMostDisagreement * board_squared;
  if (!agree || !(alignment.metres_per_unit > 0)) {
    refuse_alignment(path, "has poses that contradict those by the tags");
  }
  return alignment;
}

}  // namespace

BoardAlignment align_pairs(const std::vector<PosePair>& pairs, const std::filesystem::path& path) {
  if (pairs.size() < kFewestPairs) {
    refuse_alignment(path, fmt::format("shows the board's tags in {} images, fewer than {}",
                                       pairs.size(), kFewestPairs));
  }
  const BoardAlignment first = fitted(pairs, path);
  std::vector<double> errors;
  for (const PosePair& pair : pairs) errors.push_back(error_of(first, pair));
  std::vector<double> sorted = errors;
  const double limit = kFarOff * core::upper_median(sorted);
  std::vector<PosePair> kept;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (errors[i] <= limit) kept.push_back(pairs[i]);
  }
  return kept.size() < kFewestPairs ? first : fitted(kept, path);
}

BoardAlignment align_to_board(const Dataset& dataset, const std::filesystem::path& images,
                              const std::filesystem::path& board_file) {
  const Board board = read_board(board_file);
  std::vector<std::unique_ptr<PoseEstimator>> estimators;
  for (const core::CameraModel& camera : dataset.cameras) {
    estimators.push_back(make_tag_pose_estimator(board, camera, PoseGate{}));
  }
  StillReader reader;
  std::vector<PosePair> pairs;
  int index = 0;
  for (const DatasetFrame& frame : dataset.frames) {
    const core::CameraModel& camera = dataset.cameras.at(frame.camera);
    const Frame image{.image = reader.read(images / frame.image,
                                           ImageSize{camera.width_px(), camera.height_px()}),
                      .index = index++};
    const PoseResult result = estimators.at(frame.camera)->estimate(image);
    if (const auto* pose = std::get_if<FramePose>(&result)) {
      pairs.push_back({frame.world_from_camera, pose->camera_from_board.inverse()});
    }
  }
  return align_pairs(pairs, images);
}

}  // namespace sheen::capture
