// SPDX-License-Identifier: MIT
#include "reconstruction/silhouette/outline.h"

#include "reconstruction/silhouette/segmentation.h"
#include "reconstruction/views/bilinear.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sheen::reconstruction {
namespace {

constexpr float kDeepInside_px = -1e4F;
constexpr int kReach_px = 3;                         // of a profile, to either side
constexpr int kStepsPerPx = 2;                       // of a profile
constexpr float kLeastContrastToBackground = 0.08F;  // between object and background
constexpr float kLargestShift_px = 2;
constexpr double kAlong_px = 1.5;  // over which shifts along the outline are averaged

/// Outside and inside distance, with the index of the nearest pixel on the other side.
struct TwoDistances {
  cv::Mat outside, nearest_object;  ///< CV_32FC1, CV_32SC1
  cv::Mat inside, nearest_rest;
};

TwoDistances two_distances(const cv::Mat& object) {
  TwoDistances d;
  cv::distanceTransform(~object, d.outside, d.nearest_object, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  cv::distanceTransform(object, d.inside, d.nearest_rest, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  return d;
}

cv::Vec3f float_bilinear(const cv::Mat& image, float x_px, float y_px) {
  const int x = static_cast<int>(x_px);
  const int y = static_cast<int>(y_px);
  const float fx = x_px - static_cast<float>(x);
  const float fy = y_px - static_cast<float>(y);
  const auto* upper = image.ptr<cv::Vec3f>(y) + x;
  const auto* lower = image.ptr<cv::Vec3f>(y + 1) + x;
  return (1 - fy) * ((1 - fx) * upper[0] + fx * upper[1]) +
         fy * ((1 - fx) * lower[0] + fx * lower[1]);
}

/// How far outwards of `place` the object really ends, px; nothing where the colours do not tell.
std::optional<float> edge_shift(const cv::Mat& image, const Background& background,
                                const cv::Point2f& place, const cv::Point2f& outward) {
  constexpr int steps = kReach_px * kStepsPerPx;
  const cv::Rect2f safe(1, 1, static_cast<float>(image.cols - 3),
                        static_cast<float>(image.rows - 3));
  if (!safe.contains(place - outward * static_cast<float>(kReach_px)) ||
      !safe.contains(place + outward * static_cast<float>(kReach_px))) {
    return std::nullopt;
  }
  // The object's colour, just within.
  cv::Vec3f object(0, 0, 0);
  int inner = 0;
  const auto at = [&](int i) { return place + outward * (static_cast<float>(i) / kStepsPerPx); };
  for (int i = -steps; i <= -steps / 2; ++i, ++inner) {
    object += bilinear_bgr(image, at(i).x, at(i).y);
  }
  object *= 1.0F / static_cast<float>(inner);
  // How much of it there is at every step.
  float sum = 0;
  float first = 1;
  float last = 0;
  for (int i = -steps; i <= steps; ++i) {
    const cv::Point2f p = at(i);
    const cv::Vec3f stage = float_bilinear(background.colour, p.x, p.y);
    const cv::Vec3f contrast = object - stage;
    const float strength = contrast.dot(contrast);
    if (strength < kLeastContrastToBackground * kLeastContrastToBackground) return std::nullopt;
    const float alpha =
        std::clamp((bilinear_bgr(image, p.x, p.y) - stage).dot(contrast) / strength, 0.0F, 1.0F);
    if (i == -steps + 1) first = alpha;
    if (i == steps - 1) last = alpha;
    sum += alpha;
  }
  if (first < 0.7F || last > 0.3F) return std::nullopt;
  return (sum - 0.5F) / kStepsPerPx - static_cast<float>(kReach_px);
}

struct Shifts {
  cv::Mat shift;   ///< CV_32FC1, averaged along the outline
  cv::Mat weight;  ///< CV_32FC1, 0 where nothing is known
};

/// Shifts at the object's outermost pixels, spread to their neighbours.
Shifts outline_shifts(const cv::Mat& labels, const cv::Mat& image, const Background& background,
                      const cv::Mat& distance) {
  cv::Mat smooth;
  cv::GaussianBlur(distance, smooth, {0, 0}, 1.0);
  Shifts shifts{cv::Mat(labels.size(), CV_32FC1, cv::Scalar(0)),
                cv::Mat(labels.size(), CV_32FC1, cv::Scalar(0))};
  for (int y = 1; y + 1 < labels.rows; ++y) {
    for (int x = 1; x + 1 < labels.cols; ++x) {
      const float d = distance.at<float>(y, x);
      if (d > -0.4F || d < -0.6F) continue;  // outermost pixels have -0.5
      if (background.source.at<std::uint8_t>(y, x) !=
          static_cast<std::uint8_t>(TexelSource::seen)) {
        continue;
      }
      cv::Point2f outward(smooth.at<float>(y, x + 1) - smooth.at<float>(y, x - 1),
                          smooth.at<float>(y + 1, x) - smooth.at<float>(y - 1, x));
      const float length = std::hypot(outward.x, outward.y);
      if (length < 0.5F || length > 4) continue;  // a thin part, or what is unknown
      outward *= 1 / length;
      // The smoothed outline, to which the distance of this pixel is `smooth`.
      const float to_outline = std::clamp(-smooth.at<float>(y, x), -0.5F, 1.5F);
      const cv::Point2f place =
          cv::Point2f(static_cast<float>(x), static_cast<float>(y)) + outward * to_outline;
      const auto shift = edge_shift(image, background, place, outward);
      if (!shift || std::abs(*shift) > kLargestShift_px) continue;
      shifts.shift.at<float>(y, x) = *shift + to_outline - 0.5F;
      shifts.weight.at<float>(y, x) = 1;
    }
  }
  cv::GaussianBlur(shifts.shift, shifts.shift, {0, 0}, kAlong_px);
  cv::GaussianBlur(shifts.weight, shifts.weight, {0, 0}, kAlong_px);
  return shifts;
}

}  // namespace

cv::Mat silhouette_distance(const cv::Mat& labels) {
  const cv::Mat object = labels == static_cast<double>(PixelLabel::object);
  cv::Mat outside;
  cv::Mat inside;
  cv::distanceTransform(~object, outside, cv::DIST_L2, cv::DIST_MASK_5);
  cv::distanceTransform(object, inside, cv::DIST_L2, cv::DIST_MASK_5);
  cv::Mat distance(labels.size(), CV_32FC1);
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      const auto label = static_cast<PixelLabel>(labels.at<std::uint8_t>(y, x));
      distance.at<float>(y, x) = label == PixelLabel::object  ? 0.5F - inside.at<float>(y, x)
                                 : label == PixelLabel::stage ? outside.at<float>(y, x) - 0.5F
                                                              : kDeepInside_px;
    }
  }
  return distance;
}

cv::Mat matted_distance(const cv::Mat& labels, const cv::Mat& image, const Background& background) {
  cv::Mat distance = silhouette_distance(labels);
  const Shifts shifts = outline_shifts(labels, image, background, distance);
  const cv::Mat object = labels == static_cast<double>(PixelLabel::object);
  const TwoDistances two = two_distances(object);

  // Which pixel each label of the distance transforms means.
  const auto places_of = [&](const cv::Mat& zeros, const cv::Mat& nearest) {
    std::vector<cv::Point> places(1);
    for (int y = 0; y < zeros.rows; ++y) {
      for (int x = 0; x < zeros.cols; ++x) {
        if (zeros.at<std::uint8_t>(y, x) == 0) continue;
        const auto label = static_cast<std::size_t>(nearest.at<int>(y, x));
        if (label >= places.size()) places.resize(label + 1);
        places[label] = {x, y};
      }
    }
    return places;
  };
  const auto object_places = places_of(object, two.nearest_object);
  const cv::Mat rest = ~object;
  const auto rest_places = places_of(rest, two.nearest_rest);
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      const bool inside = object.at<std::uint8_t>(y, x) != 0;
      const auto label = static_cast<std::size_t>(inside ? two.nearest_rest.at<int>(y, x)
                                                         : two.nearest_object.at<int>(y, x));
      const auto& places = inside ? rest_places : object_places;
      if (label >= places.size()) continue;
      const float weight = shifts.weight.at<float>(places[label]);
      if (weight < 0.02F) continue;
      distance.at<float>(y, x) -= shifts.shift.at<float>(places[label]) / weight;
    }
  }
  return distance;
}

}  // namespace sheen::reconstruction
