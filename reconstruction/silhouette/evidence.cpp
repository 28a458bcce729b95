// SPDX-License-Identifier: MIT
#include "reconstruction/silhouette/evidence.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace sheen::reconstruction {
namespace {

constexpr float kMostDistance = 30;
constexpr double kBlurPx = 0.7;
constexpr float kEven = 4;              // distance at which object and stage are equally likely
constexpr float kDeepestShadow = 0.6F;  // of the light on paper that no view shows
constexpr float kNoShadow = 1.05F;
constexpr float kEvenGuessed = 2.5F;  // where the stage is guessed

/// What is left of a colour when as much of the expected one is taken away as a shadow leaves.
cv::Vec3f but_for_shadow(const cv::Vec3f& colour, const cv::Vec3f& expected) {
  const float light = colour.dot(expected) / std::max(expected.dot(expected), 1e-3F);
  return colour - std::clamp(light, kDeepestShadow, kNoShadow) * expected;
}

}  // namespace

Evidence compare_with_background(const cv::Mat& image, const Background& background) {
  Evidence evidence;
  evidence.known = background.source != 0;
  evidence.residual = cv::Mat(image.size(), CV_32FC3);
  cv::Mat distance(image.size(), CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    const auto* bgr = image.ptr<cv::Vec3b>(y);
    const auto* expected = background.colour.ptr<cv::Vec3f>(y);
    const auto* sigma = background.sigma.ptr<float>(y);
    const auto* known = evidence.known.ptr<std::uint8_t>(y);
    const auto* source = background.source.ptr<std::uint8_t>(y);
    auto* residual = evidence.residual.ptr<cv::Vec3f>(y);
    auto* d = distance.ptr<float>(y);
    for (int x = 0; x < image.cols; ++x) {
      const cv::Vec3f colour = cv::Vec3f(bgr[x]) * (1.0F / 255);
      const bool guessed = source[x] == static_cast<std::uint8_t>(TexelSource::inpainted);
      residual[x] = known[x] == 0 ? colour
                    : guessed     ? but_for_shadow(colour, expected[x])
                                  : cv::Vec3f(colour - expected[x]);
      d[x] = known[x] != 0
                 ? std::min(residual[x].dot(residual[x]) / (2 * sigma[x] * sigma[x]), kMostDistance)
                 : 0;
    }
  }
  cv::GaussianBlur(distance, distance, {0, 0}, kBlurPx);
  evidence.log_odds = cv::Mat(image.size(), CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    const auto* source = background.source.ptr<std::uint8_t>(y);
    const auto* d = distance.ptr<float>(y);
    auto* odds = evidence.log_odds.ptr<float>(y);
    for (int x = 0; x < image.cols; ++x) {
      switch (static_cast<TexelSource>(source[x])) {
        case TexelSource::unknown:
          odds[x] = 0;
          break;
        case TexelSource::inpainted:
          odds[x] = std::clamp(d[x] - kEvenGuessed, -0.5F, 3.0F);
          break;
        case TexelSource::seen:
          odds[x] = std::clamp(d[x] - kEven, -3.0F, 6.0F);
          break;
      }
    }
  }
  return evidence;
}

}  // namespace sheen::reconstruction
