// SPDX-License-Identifier: MIT
#include "capture/calibration/calibration_target.h"

#include "capture/pose/corner_refinement.h"
#include "capture/pose/tag_detector.h"

#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace sheen::capture {
namespace {

constexpr std::size_t kMinTags = 3;  // twelve points: a pose and some to spare
constexpr int kMinCorners = 3;
constexpr double kTypicalFocal = 1.1;  // over the longer side: between a phone and a webcam

class BoardFinder : public TargetFinder {
 public:
  explicit BoardFinder(const Board& board)
      : board_(board), family_(family_of(board)), detector_(family_) {}

  std::optional<TargetView> find(const cv::Mat& grey) override {
    auto tags = drop_ambiguous(detector_.detect(grey));
    std::erase_if(tags, [&](const TagDetection& tag) { return !board_.tags.contains(tag.id); });
    if (tags.size() < kMinTags) return std::nullopt;
    TargetView view;
    for (const TagDetection& tag : tags) {
      const auto corners = board_.tags.at(tag.id).corners_in_board();
      view.on_target.insert(view.on_target.end(), corners.begin(), corners.end());
      view.in_image.insert(view.in_image.end(), tag.corners_px.begin(), tag.corners_px.end());
    }
    refine(grey, plain_camera({grey.cols, grey.rows}), view);
    return view;
  }

  void refine(const cv::Mat& grey, const core::CameraModel& camera,
              TargetView& view) const override {
    for (std::size_t first = 0; first + 4 <= view.in_image.size(); first += 4) {
      std::array<Eigen::Vector2d, 4> corners;
      const auto begin = view.in_image.begin() + static_cast<std::ptrdiff_t>(first);
      std::copy(begin, begin + 4, corners.begin());
      refine_corners(grey, camera, family_.modules, corners);
      std::copy(corners.begin(), corners.end(), begin);
    }
  }

 private:
  static TagFamily family_of(const Board& board) {
    const auto family = find_tag_family(board.family, board.border_bits);
    if (!family) throw std::invalid_argument("no detector knows the tag family " + board.family);
    return *family;
  }

  Board board_;
  TagFamily family_;
  TagDetector detector_;
};

class ChessboardFinder : public TargetFinder {
 public:
  explicit ChessboardFinder(const Chessboard& board) : board_(board) {
    if (board.columns < kMinCorners || board.rows < kMinCorners || !(board.square_m > 0)) {
      throw std::invalid_argument("chessboard: must have at least 3x3 inner corners");
    }
  }

  std::optional<TargetView> find(const cv::Mat& grey) override {
    std::vector<cv::Point2f> corners;
    if (!cv::findChessboardCornersSB(grey, {board_.columns, board_.rows}, corners,
                                     cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY)) {
      return std::nullopt;
    }
    TargetView view;
    for (int row = 0; row < board_.rows; ++row) {
      for (int column = 0; column < board_.columns; ++column) {
        const auto i = static_cast<std::size_t>(row * board_.columns + column);
        view.on_target.emplace_back(column * board_.square_m, row * board_.square_m, 0);
        view.in_image.emplace_back(Eigen::Vector2f(corners[i].x, corners[i].y).cast<double>());
      }
    }
    return view;
  }

  /// Saddle points are local: the lens changes nothing about where they are seen.
  void refine(const cv::Mat&, const core::CameraModel&, TargetView&) const override {}

 private:
  Chessboard board_;
};

}  // namespace

core::CameraModel plain_camera(const ImageSize& size) {
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = size.width_px;
  intrinsics.height_px = size.height_px;
  intrinsics.focal_px.setConstant(kTypicalFocal * std::max(size.width_px, size.height_px));
  intrinsics.principal_px << (size.width_px - 1) / 2.0, (size.height_px - 1) / 2.0;
  return core::CameraModel(intrinsics);
}

std::unique_ptr<TargetFinder> make_target_finder(const CalibrationTarget& target) {
  if (const auto* board = std::get_if<Board>(&target)) return std::make_unique<BoardFinder>(*board);
  return std::make_unique<ChessboardFinder>(std::get<Chessboard>(target));
}

}  // namespace sheen::capture
