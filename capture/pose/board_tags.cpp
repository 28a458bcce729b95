// SPDX-License-Identifier: MIT
#include "capture/pose/board_tags.h"

#include "capture/pose/corner_refinement.h"

#include <opencv2/imgproc.hpp>

#include <stdexcept>

namespace sheen::capture {
namespace {

TagFamily family_of(const Board& board) {
  const auto family = find_tag_family(board.family, board.border_bits);
  if (!family) throw std::invalid_argument("no detector knows the tag family " + board.family);
  return *family;
}

}  // namespace

cv::Mat grey_of(const Frame& frame) {
  if (!frame.grey.empty()) return frame.grey;
  cv::Mat grey;
  cv::cvtColor(frame.image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

BoardTagFinder::BoardTagFinder(const Board& board, const core::CameraModel& camera)
    : board_(board), camera_(camera), family_(family_of(board)), detector_(family_) {}

const cv::Mat& BoardTagFinder::look_at(const Frame& frame) {
  if (frame.grey.empty()) {
    cv::cvtColor(frame.image, buffer_, cv::COLOR_BGR2GRAY);
    grey_ = buffer_;
  } else {
    grey_ = frame.grey;
  }
  return grey_;
}

std::vector<TagDetection> BoardTagFinder::find() const {
  std::vector<TagDetection> tags = drop_ambiguous(detector_.detect(grey_));
  std::erase_if(tags, [&](const TagDetection& tag) { return !board_.tags.contains(tag.id); });
  for (TagDetection& tag : tags) refine_corners(grey_, camera_, family_.modules, tag.corners_px);
  return tags;
}

}  // namespace sheen::capture
