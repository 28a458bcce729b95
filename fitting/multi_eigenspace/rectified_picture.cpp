// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/rectified_picture.h"

#include "core/concurrency/parallel_for.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace sheen::fitting::multi_eigenspace {
namespace {

/// Where the pixels of a picture, drawn `finer` times as fine, lie in a photograph's crop:
/// CV_32FC2, far outside where the lens has none.
cv::Mat places_in(const KeptView& view, const PictureFrame& frame, const Billboard& board,
                  int side_px, int threads) {
  cv::Mat places(side_px, side_px, CV_32FC2);
  const double step = 2 * board.half_side_m / side_px;
  const auto row = [&](int y) {
    const double down = (y + 0.5) * step - board.half_side_m;
    for (int x = 0; x < side_px; ++x) {
      const double right = (x + 0.5) * step - board.half_side_m;
      const auto pixel = view.camera.project(
          view.camera_from_object * (frame.centre + right * board.right + down * board.down));
      constexpr float outside = -1e4f;
      auto& place = places.at<cv::Vec2f>(y, x);
      place = {outside, outside};
      if (!pixel) continue;
      place = {static_cast<float>(pixel->x() - view.crop.x),
               static_cast<float>(pixel->y() - view.crop.y)};
    }
  };
  constexpr std::size_t rows = 16;
  core::parallel_for(
      static_cast<std::size_t>(side_px), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) row(static_cast<int>(y));
      },
      rows);
  return places;
}

/// How many pixels of the photograph lie along one of the picture: so much finer it is read.
int finer(const KeptView& view, const Billboard& board, int side_px) {
  constexpr int most = 8;
  const double pixels =
      2 * board.half_side_m / board.distance_m * view.camera.intrinsics().focal_px.maxCoeff();
  return std::clamp(static_cast<int>(std::ceil(pixels / side_px)), 1, most);
}

/// Fills where `weight` is below 1 from what is around, from fine to coarse and back. `colour` is
/// CV_32FC3, weighted.
cv::Mat continued(const cv::Mat& colour, const cv::Mat& weight) {
  if (colour.rows == 1 && colour.cols == 1) {
    const float sum = weight.at<float>(0, 0);
    constexpr float grey = 128.0f;
    return sum > 0.0f ? cv::Mat(colour / sum)
                      : cv::Mat(colour.size(), CV_32FC3, cv::Scalar::all(grey));
  }
  const cv::Size half((colour.cols + 1) / 2, (colour.rows + 1) / 2);
  cv::Mat coarse_colour, coarse_weight;
  cv::resize(colour, coarse_colour, half, 0, 0, cv::INTER_AREA);
  cv::resize(weight, coarse_weight, half, 0, 0, cv::INTER_AREA);
  // Some of a block's pixels are enough to know its colour.
  constexpr float block = 4.0f;
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      auto& own = coarse_weight.at<float>(y, x);
      const float more = own > 0.0f ? std::min(block, 1.0f / own) : 0.0f;
      own *= more;
      coarse_colour.at<cv::Vec3f>(y, x) *= more;
    }
  }
  cv::Mat around;
  cv::resize(continued(coarse_colour, coarse_weight), around, colour.size(), 0, 0,
             cv::INTER_LINEAR);
  for (int y = 0; y < colour.rows; ++y) {
    for (int x = 0; x < colour.cols; ++x) {
      const float rest = 1.0f - weight.at<float>(y, x);
      auto& filled = around.at<cv::Vec3f>(y, x);
      filled = colour.at<cv::Vec3f>(y, x) + rest * filled;
    }
  }
  return around;
}

cv::Mat reduced(const cv::Mat& fine, int side_px) {
  cv::Mat image;
  cv::resize(fine, image, {side_px, side_px}, 0, 0, cv::INTER_AREA);
  return image;
}

}  // namespace

Rectifier::Rectifier(const core::Mesh& mesh, int threads)
    : points_(core::surface_points(mesh)), depth_(mesh, threads), threads_(threads) {}

/// CV_8UC1 of the crop: 255 where the mesh is seen.
cv::Mat Rectifier::mask_of(const KeptView& view) {
  core::project_vertices(points_, view.camera, view.camera_from_object, {}, threads_, view_);
  depth_.draw(view_, {view.camera.width_px(), view.camera.height_px()}, view.camera_from_object);
  cv::Mat mask(view.crop.size(), CV_8UC1, cv::Scalar(0));
  const cv::Rect common = view.crop & depth_.box();
  if (!common.empty()) {
    mask(common - view.crop.tl()).setTo(255, depth_.depth_m()(common - depth_.box().tl()) > 0.0f);
  }
  return mask;
}

cv::Mat Rectifier::picture(const KeptView& view, const PictureFrame& frame, int side_px) {
  const Billboard board = billboard_towards(frame, view.eye()).value();
  const int fine_px = side_px * finer(view, board, side_px);
  const cv::Mat places = places_in(view, frame, board, fine_px, threads_);

  // Pixels beside the outline mix object and background.
  const cv::Mat mask = mask_of(view);
  cv::Mat inside;
  cv::erode(mask, inside, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  if (cv::countNonZero(inside) == 0) inside = mask;

  cv::Mat colour, covered, weight;
  cv::remap(view.pixels(), colour, places, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::remap(mask, covered, places, {}, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  cv::remap(inside, weight, places, {}, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  weight = weight == 255;
  colour.setTo(cv::Scalar::all(0), ~weight);
  cv::Mat weighted, share;
  colour.convertTo(weighted, CV_32FC3);
  weight.convertTo(share, CV_32FC1, 1.0 / 255);
  cv::Mat filled;
  continued(reduced(weighted, side_px), reduced(share, side_px)).convertTo(filled, CV_8UC3);

  cv::Mat picture;
  cv::merge(std::vector<cv::Mat>{filled, reduced(covered, side_px)}, picture);
  return picture;
}

}  // namespace sheen::fitting::multi_eigenspace
