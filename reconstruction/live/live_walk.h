// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/board_tags.h"
#include "capture/pose/tag_detector.h"
#include "capture/source/frame.h"
#include "core/geometry/camera.h"
#include "reconstruction/live/view_directions.h"
#include "reconstruction/views/view_set.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <array>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace sheen::reconstruction {

/// What a walk is known to be before it begins.
struct WalkStart {
  std::filesystem::path session;        ///< for messages
  std::optional<capture::Board> board;  ///< nothing: the default sheet, recognised by its ids
  core::CameraModel camera;
  bool camera_is_guessed = false;  ///< calibrated from the tags as the walk goes on
};

/// The image last looked at.
struct WalkSight {
  int frames = 0;                                      ///< looked at so far
  cv::Mat image;                                       ///< CV_8UC3, shared, never written to
  std::optional<Eigen::Isometry3d> camera_from_board;  ///< nothing: too few tags were seen
  core::CameraModel camera;
  std::vector<std::size_t> missing;  ///< view directions that nobody has looked from, ascending
  std::optional<Eigen::Vector3d> middle;  ///< of the tags, board frame; once the board is known
};

/// One view from every direction seen so far, their images reduced.
struct WalkViews {
  capture::Board board;
  core::CameraModel camera;  ///< of the reduced images
  std::vector<PosedImage> views;
  int lenses = 0;  ///< how often the camera has been estimated anew
};

/// A walk while it is filmed: looks at some frames a second, poses them by their tags, keeps the
/// one nearest to the middle of every view direction. The camera, where it is guessed, is
/// calibrated again whenever directions have become half as many again. `look_at` belongs to one
/// thread, the rest to any.
class LiveWalk {
 public:
  explicit LiveWalk(WalkStart start);

  /// The next frame of the recording; most are passed over. Throws core::Error (bad_input) when the
  /// first frames show tags, but of another board.
  void look_at(const capture::Frame& frame);

  [[nodiscard]] WalkSight sight() const;
  /// Nothing before the board is known.
  [[nodiscard]] std::optional<WalkViews> views() const;

 private:
  struct KeptView {
    std::vector<capture::TagDetection> tags;
    PosedImage view;       ///< reduced
    double closeness = 0;  ///< cosine of the angle to its direction's middle
  };

  void recognise_board(const capture::Frame& frame);
  void keep(const capture::Frame& frame, const Eigen::Isometry3d& camera_from_board,
            std::vector<capture::TagDetection> tags);
  void calibrate();
  void list_missing();
  void use(const core::CameraModel& camera);

  WalkStart start_;
  std::optional<capture::BoardTagFinder> finder_;
  double next_look_s_ = 0;
  std::size_t calibrate_at_;  ///< directions seen

  mutable std::mutex mutex_;  ///< of everything below, and of board and camera
  std::array<std::optional<KeptView>, kViewDirections> kept_;
  std::size_t seen_ = 0;  ///< of them
  WalkSight sight_;
  int lenses_ = 0;
};

}  // namespace sheen::reconstruction
