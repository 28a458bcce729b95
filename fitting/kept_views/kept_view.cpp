// SPDX-License-Identifier: MIT
#include "fitting/kept_views/kept_view.h"

#include "core/diagnostics/error.h"
#include "core/image/jpeg.h"

#include <opencv2/imgproc.hpp>

#include <cassert>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace sheen::fitting {
namespace {

constexpr int kLeastQuality = 1;
constexpr int kBestQuality = 100;
constexpr int kLargestCache_mb = 1 << 20;

/// Side of the blocks that a JPEG with halved chroma codes on their own, pixels.
constexpr int kBlock_px = 16;
/// Pixels around the object that readings between pixels and edges of depth may touch.
constexpr int kMargin_px = 4;

/// Greys the blocks in which nothing is near the object. Blocks are coded on their own, so the
/// others do not change.
void grey_background(const cv::Mat& depth_m, cv::Mat& image) {
  const cv::Size side(2 * kMargin_px + 1, 2 * kMargin_px + 1);
  cv::Mat near;
  cv::dilate(depth_m > 0.0f, near, cv::getStructuringElement(cv::MORPH_RECT, side));
  for (int y = 0; y < image.rows; y += kBlock_px) {
    for (int x = 0; x < image.cols; x += kBlock_px) {
      const cv::Rect block = cv::Rect(x, y, kBlock_px, kBlock_px) & cv::Rect({}, image.size());
      if (cv::countNonZero(near(block)) == 0) image(block).setTo(cv::Scalar::all(128));
    }
  }
}

/// Continues the object's colours over what lies beside it, so that drawing a little more than the
/// object shows no background. Its outermost pixels, which mix both, are not continued except where
/// it is no thicker; they stay as they are, like all of its pixels.
void continue_object(const cv::Mat& depth_m, cv::Mat& image) {
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  const cv::Mat object = depth_m > 0.0f;
  cv::Mat inner, thick;
  cv::erode(object, inner, square);
  cv::dilate(inner, thick, square);
  const cv::Mat sources = inner | (object & ~thick);

  // Label every pixel by its nearest source, and find these by their labels.
  cv::Mat distance, label;
  cv::distanceTransform(~sources, distance, label, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  std::vector<cv::Vec3b> colour_of(static_cast<std::size_t>(cv::countNonZero(sources)) + 1);
  const auto visit = [&](const cv::Mat& mask, const auto& at) {
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        if (mask.at<std::uint8_t>(y, x) == 0) continue;
        at(colour_of[static_cast<std::size_t>(label.at<int>(y, x))], image.at<cv::Vec3b>(y, x));
      }
    }
  };
  visit(sources, [](cv::Vec3b& colour, const cv::Vec3b& pixel) { colour = pixel; });
  visit(~object, [](const cv::Vec3b& colour, cv::Vec3b& pixel) { pixel = colour; });
}

void refuse_outside(const char* name, int value, int least, int most) {
  if (value >= least && value <= most) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + ", allowed: " +
                              std::to_string(least) + " to " + std::to_string(most));
}

}  // namespace

cv::Mat KeptView::pixels() const {
  if (auto image = core::decode_jpeg(std::as_bytes(std::span(jpeg)), crop.size())) return *image;
  throw core::bad_input("the model", "holds a photograph that cannot be decoded",
                        "make it again with sheen replay");
}

Eigen::Vector3d KeptView::eye() const {
  return camera_from_object.linear().transpose() * -camera_from_object.translation();
}

KeptView keep_view(const core::Observation& observation, const core::DepthImage& depth, int quality,
                   Surroundings surroundings) {
  assert(!depth.box().empty());
  cv::Mat image;
  observation.image(depth.box()).convertTo(image, CV_8UC3, 1 / observation.gain);
  if (surroundings == Surroundings::continued) continue_object(depth.depth_m(), image);
  grey_background(depth.depth_m(), image);
  return {observation.camera, observation.camera_from_object, depth.box(),
          core::encode_jpeg(image, quality)};
}

void add_options(KeptViewOptions& options, OptionTable& table) {
  table.push_back(number_option("image-quality", options.quality, kLeastQuality, kBestQuality,
                                "Quality of the JPEGs in which photographs are kept"));
  table.push_back(number_option("image-cache-mb", options.cache_mb, 0, kLargestCache_mb,
                                "Photographs that stay decoded while the model is drawn, MB"));
}

void check(const KeptViewOptions& options) {
  refuse_outside("image-quality", options.quality, kLeastQuality, kBestQuality);
  refuse_outside("image-cache-mb", options.cache_mb, 0, kLargestCache_mb);
}

}  // namespace sheen::fitting
