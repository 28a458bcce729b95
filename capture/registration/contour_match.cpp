// SPDX-License-Identifier: MIT
#include "capture/registration/contour_match.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sheen::capture {
namespace {

constexpr int kMostReachPx = 60;
constexpr int kContextPx = 6;  // line beyond the reach, so that its ends can be judged, too
constexpr std::size_t kMostSteps = 2 * (kMostReachPx + kContextPx) + 1;
// Neighbouring pixels tell nearly the same: each counts this share of an independent one.
constexpr double kIndependence = 0.35;
constexpr double kPixelSigmaPx = 0.7;  // what a colour step can be told to at best

constexpr int kEdgeStepsPerPx = 2;
constexpr float kWeakestEdge = 3;      // grey levels per px
constexpr double kClearEdge = 14;      // weight grows up to here
constexpr double kContradicted = 0.1;  // what an edge still counts against which the colours speak

bool is_inside(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  return pixel.x() >= 1 && pixel.y() >= 1 && pixel.x() < image.cols - 2 &&
         pixel.y() < image.rows - 2;
}

const cv::Vec3b& nearest(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  return image.at<cv::Vec3b>(static_cast<int>(std::lround(pixel.y())),
                             static_cast<int>(std::lround(pixel.x())));
}

cv::Vec3f bilinear(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  const int x = static_cast<int>(pixel.x());
  const int y = static_cast<int>(pixel.y());
  const auto fx = static_cast<float>(pixel.x() - x);
  const auto fy = static_cast<float>(pixel.y() - y);
  const auto* upper = image.ptr<cv::Vec3b>(y) + x;
  const auto* lower = image.ptr<cv::Vec3b>(y + 1) + x;
  const cv::Vec3f top = (1 - fx) * cv::Vec3f(upper[0]) + fx * cv::Vec3f(upper[1]);
  const cv::Vec3f bottom = (1 - fx) * cv::Vec3f(lower[0]) + fx * cv::Vec3f(lower[1]);
  return (1 - fy) * top + fy * bottom;
}

/// Sum of evidence for "object" from the inner end of the line up to each place on it.
struct EvidenceLine {
  std::array<double, kMostSteps + 1> sum;
  int half = 0;

  /// Log-likelihood, up to a constant, of the object's edge at `offset` pixels outwards: all within
  /// is object, all beyond is not.
  [[nodiscard]] double at(int offset) const {
    return 2 * sum[static_cast<std::size_t>(offset + half)] -
           sum[static_cast<std::size_t>(2 * half + 1)];
  }
};

std::optional<EvidenceLine> read_evidence(const cv::Mat& image, const ColourStatistics& colours,
                                          const ContourPoint& point, int reach_px) {
  EvidenceLine line;
  line.half = std::min(reach_px, kMostReachPx) + kContextPx;
  if (!is_inside(image, point.pixel - line.half * point.outward) ||
      !is_inside(image, point.pixel + line.half * point.outward)) {
    return std::nullopt;
  }
  line.sum[0] = 0;
  for (int k = -line.half; k <= line.half; ++k) {
    const auto i = static_cast<std::size_t>(k + line.half);
    const float evidence = colours.evidence(nearest(image, point.pixel + k * point.outward));
    line.sum[i + 1] = line.sum[i] + 0.5 * kIndependence * static_cast<double>(evidence);
  }
  return line;
}

/// Colour change per pixel along the line, every half pixel, one step beyond the reach at both
/// ends.
using ChangeLine = std::array<float, 2 * kMostReachPx * kEdgeStepsPerPx + 3>;

ChangeLine read_change(const cv::Mat& image, const ContourPoint& point, int steps) {
  constexpr double arm_px = 0.75;
  ChangeLine change{};
  for (int k = -steps - 1; k <= steps + 1; ++k) {
    const Eigen::Vector2d at =
        point.pixel + k / static_cast<double>(kEdgeStepsPerPx) * point.outward;
    const cv::Vec3f difference =
        bilinear(image, at + arm_px * point.outward) - bilinear(image, at - arm_px * point.outward);
    change[static_cast<std::size_t>(k + steps + 1)] =
        std::sqrt(difference.dot(difference) / 3) / static_cast<float>(2 * arm_px);
  }
  return change;
}

/// Place of the local maximum at step `k`, px, by a parabola; nothing where there is none.
std::optional<double> maximum_near(const ChangeLine& change, int k, int steps) {
  const auto i = static_cast<std::size_t>(k + steps + 1);
  const float here = change[i];
  if (here < kWeakestEdge || here < change[i - 1] || here <= change[i + 1]) return std::nullopt;
  const auto bend = static_cast<double>(change[i - 1] - 2 * here + change[i + 1]);
  const double fraction =
      bend < 0 ? 0.5 * static_cast<double>(change[i - 1] - change[i + 1]) / bend : 0;
  return (k + fraction) / kEdgeStepsPerPx;
}

}  // namespace

std::optional<ContourMatch> match_by_colour(const cv::Mat& image, const ColourStatistics& colours,
                                            const ContourPoint& point, int reach_px) {
  const int reach = std::min(reach_px, kMostReachPx);
  const auto line = read_evidence(image, colours, point, reach);
  if (!line) return std::nullopt;

  // Mean and variance of the edge's place; an edge "at k" lies before the pixel k.
  double best = line->at(-reach);
  for (int k = -reach; k <= reach; ++k) best = std::max(best, line->at(k));
  double sum = 0;
  double first = 0;
  double second = 0;
  for (int k = -reach; k <= reach; ++k) {
    const double p = std::exp(line->at(k) - best);
    const double offset = k - 0.5;
    sum += p;
    first += p * offset;
    second += p * offset * offset;
  }
  const double mean = first / sum;
  const double variance = std::max(0.0, second / sum - mean * mean);

  // A flat likelihood has the variance of the whole reach and says nothing.
  const double flat = reach * (reach + 1) / 3.0;
  const double floor = kPixelSigmaPx * kPixelSigmaPx;
  const double weight = floor / (variance + floor) - floor / (flat + floor);
  if (!(weight > 0)) return std::nullopt;
  return ContourMatch{mean, weight};
}

std::optional<ContourMatch> match_by_edge(const cv::Mat& image, const ColourStatistics& colours,
                                          const ContourPoint& point, double reach_px) {
  const int reach = std::min(static_cast<int>(std::ceil(reach_px)), kMostReachPx);
  const int steps = reach * kEdgeStepsPerPx;
  const auto line = read_evidence(image, colours, point, reach);
  if (!line) return std::nullopt;
  const ChangeLine change = read_change(image, point, steps);
  double best_likelihood = line->at(0);
  for (int k = -reach; k <= reach; ++k) best_likelihood = std::max(best_likelihood, line->at(k));

  // Take the best of the maxima.
  std::optional<ContourMatch> match;
  double best_score = 0;
  for (int k = -steps; k <= steps; ++k) {
    const auto offset = maximum_near(change, k, steps);
    if (!offset) continue;
    const int pixel = std::clamp(static_cast<int>(std::lround(*offset + 0.5)), -reach, reach);
    const double likely = std::exp(line->at(pixel) - best_likelihood);
    const double near = std::exp(-2 * *offset * *offset / (reach_px * reach_px));
    const auto strength = static_cast<double>(change[static_cast<std::size_t>(k + steps + 1)]);
    const double score = strength * near * (kContradicted + likely);
    if (score <= best_score) continue;
    best_score = score;
    match = ContourMatch{*offset, std::min(1.0, strength / kClearEdge) *
                                      (kContradicted + (1 - kContradicted) * likely)};
  }
  return match;
}

}  // namespace sheen::capture
