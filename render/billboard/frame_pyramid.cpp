// SPDX-License-Identifier: MIT
#include "render/billboard/frame_pyramid.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace sheen::render {
namespace {

Eigen::Vector4f pixel_or_nothing(const cv::Mat& image, int x, int y) {
  if (x < 0 || y < 0 || x >= image.cols || y >= image.rows) return Eigen::Vector4f::Zero();
  return Eigen::Map<const Eigen::Vector4f>(image.ptr<float>(y) + std::ptrdiff_t{4} * x);
}

/// The pixel of the crop at a place of the frame or next to it.
cv::Point within(const cv::Mat& crop, float x, float y) {
  return {static_cast<int>(std::clamp(x, 0.0f, static_cast<float>(crop.cols - 1))),
          static_cast<int>(std::clamp(y, 0.0f, static_cast<float>(crop.rows - 1)))};
}

}  // namespace

FramePyramid::FramePyramid(const fitting::billboard::FrameImage& image, int side_px)
    : side_px_(static_cast<float>(side_px)),
      crop_px_(static_cast<float>(image.crop.x), static_cast<float>(image.crop.y)) {
  cv::extractChannel(image.shape, covered_, 0);
  cv::extractChannel(image.shape, depth_code_, 1);
  cv::extractChannel(image.shape, supported_, 2);
  cv::Mat whole(side_px, side_px, CV_32FC4, cv::Scalar::all(0));
  for (int y = 0; y < image.crop.height; ++y) {
    const auto* const colour = image.colour.ptr<cv::Vec3b>(y);
    const auto* const shape = image.shape.ptr<cv::Vec3b>(y);
    auto* const row = whole.ptr<cv::Vec4f>(y + image.crop.y) + image.crop.x;
    for (int x = 0; x < image.crop.width; ++x) {
      const float coverage = static_cast<float>(shape[x][0]) / 255.0f;
      row[x] = {coverage * static_cast<float>(colour[x][0]),
                coverage * static_cast<float>(colour[x][1]),
                coverage * static_cast<float>(colour[x][2]), coverage};
    }
  }
  levels_.push_back(std::move(whole));
  while (levels_.back().cols > 1) {
    cv::Mat half;
    const int side = levels_.back().cols / 2;
    cv::resize(levels_.back(), half, {side, side}, 0, 0, cv::INTER_AREA);
    levels_.push_back(std::move(half));
  }
}

Eigen::Vector4f FramePyramid::read_level(const Eigen::Vector2f& place_px, std::size_t level) const {
  const cv::Mat& image = levels_[level];
  const float scale = static_cast<float>(image.cols) / side_px_;
  const float x = (place_px.x() + 0.5f) * scale - 0.5f;
  const float y = (place_px.y() + 0.5f) * scale - 0.5f;
  const auto side = static_cast<float>(image.cols);
  // Written so that a place that is none has nothing.
  if (!(x > -1.0f && y > -1.0f && x < side && y < side)) return Eigen::Vector4f::Zero();
  const float left = std::floor(x);
  const float top = std::floor(y);
  const float u = x - left;
  const float v = y - top;
  const int column = static_cast<int>(left);
  const int row = static_cast<int>(top);
  const Eigen::Vector4f above =
      (1 - u) * pixel_or_nothing(image, column, row) + u * pixel_or_nothing(image, column + 1, row);
  const Eigen::Vector4f below = (1 - u) * pixel_or_nothing(image, column, row + 1) +
                                u * pixel_or_nothing(image, column + 1, row + 1);
  return (1 - v) * above + v * below;
}

Eigen::Vector4f FramePyramid::read(const Eigen::Vector2f& place_px, float level) const {
  const float within_levels = std::clamp(level, 0.0f, static_cast<float>(levels_.size() - 1));
  const auto fine = static_cast<std::size_t>(within_levels);
  const float share = within_levels - static_cast<float>(fine);
  const Eigen::Vector4f finer = read_level(place_px, fine);
  if (share == 0.0f) return finer;
  return (1 - share) * finer + share * read_level(place_px, fine + 1);
}

float FramePyramid::depth_code(const Eigen::Vector2f& place_px) const {
  const float x =
      std::clamp(place_px.x() - crop_px_.x, 0.0f, static_cast<float>(depth_code_.cols - 1));
  const float y =
      std::clamp(place_px.y() - crop_px_.y, 0.0f, static_cast<float>(depth_code_.rows - 1));
  const cv::Point first = within(depth_code_, x, y);
  const cv::Point last = within(depth_code_, x + 1, y + 1);
  const float u = x - static_cast<float>(first.x);
  const float v = y - static_cast<float>(first.y);
  const auto at = [&](int column, int row) {
    return static_cast<float>(depth_code_.at<std::uint8_t>(row, column));
  };
  return (1 - v) * ((1 - u) * at(first.x, first.y) + u * at(last.x, first.y)) +
         v * ((1 - u) * at(first.x, last.y) + u * at(last.x, last.y));
}

std::optional<std::uint8_t> FramePyramid::surface_code(const Eigen::Vector2f& place_px) const {
  const float x = place_px.x() - crop_px_.x + 0.5f;
  const float y = place_px.y() - crop_px_.y + 0.5f;
  if (!(x >= 0.0f && y >= 0.0f && x < static_cast<float>(covered_.cols) &&
        y < static_cast<float>(covered_.rows))) {
    return std::nullopt;
  }
  const cv::Point pixel(static_cast<int>(x), static_cast<int>(y));
  if (covered_.at<std::uint8_t>(pixel) == 0) return std::nullopt;
  return depth_code_.at<std::uint8_t>(pixel);
}

bool FramePyramid::is_supported(const Eigen::Vector2f& place_px) const {
  return supported_.at<std::uint8_t>(within(supported_, place_px.x() - crop_px_.x + 0.5f,
                                            place_px.y() - crop_px_.y + 0.5f)) != 0;
}

std::size_t FramePyramid::byte_size() const {
  std::size_t bytes = covered_.total() + depth_code_.total() + supported_.total();
  for (const cv::Mat& level : levels_) bytes += level.total() * level.elemSize();
  return bytes;
}

}  // namespace sheen::render
