// SPDX-License-Identifier: MIT
#include "reconstruction/silhouette/segmentation.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc/detail/gcgraph.hpp>

#include <array>
#include <cmath>

namespace sheen::reconstruction {
namespace {

constexpr float kSmoothness = 2.5F;
constexpr float kLeastSmoothness = 0.15F;  // share of it that is left across an edge
constexpr float kContrast = 0.06F;         // of the residual, at which smoothness falls to 1 / e

struct Step {
  int dx, dy;
  float strength;  // 1 / length
};
constexpr std::array<Step, 4> kSteps{{{1, 0, 1}, {0, 1, 1}, {1, 1, 0.7071F}, {-1, 1, 0.7071F}}};

float smoothness(const cv::Vec3f& a, const cv::Vec3f& b, float strength) {
  const cv::Vec3f d = a - b;
  const float contrast = d.dot(d) / (kContrast * kContrast);
  return kSmoothness * strength * (kLeastSmoothness + (1 - kLeastSmoothness) * std::exp(-contrast));
}

}  // namespace

cv::Mat segment(const Evidence& evidence, const cv::Mat& prior, const cv::Rect& region) {
  const cv::Rect box = region & cv::Rect({0, 0}, evidence.log_odds.size());
  const auto nodes = static_cast<unsigned>(box.area());
  cv::detail::GCGraph<float> graph(nodes, 8 * nodes);
  const auto node = [&](int x, int y) { return (y - box.y) * box.width + x - box.x; };
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      const float odds =
          evidence.log_odds.at<float>(y, x) + (prior.empty() ? 0.0F : prior.at<float>(y, x));
      const int n = graph.addVtx();
      graph.addTermWeights(n, std::max(odds, 0.0F), std::max(-odds, 0.0F));
    }
  }
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      const auto& here = evidence.residual.at<cv::Vec3f>(y, x);
      for (const Step& step : kSteps) {
        const cv::Point there(x + step.dx, y + step.dy);
        if (!box.contains(there)) continue;
        const float w = smoothness(here, evidence.residual.at<cv::Vec3f>(there), step.strength);
        graph.addEdges(node(x, y), node(there.x, there.y), w, w);
      }
    }
  }
  graph.maxFlow();
  cv::Mat labels(evidence.log_odds.size(), CV_8UC1,
                 cv::Scalar(static_cast<double>(PixelLabel::stage)));
  labels.setTo(static_cast<double>(PixelLabel::unknown), evidence.known == 0);
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      if (graph.inSourceSegment(node(x, y))) {
        labels.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(PixelLabel::object);
      }
    }
  }
  return labels;
}

}  // namespace sheen::reconstruction
