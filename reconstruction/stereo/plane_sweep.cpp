// SPDX-License-Identifier: MIT
#include "reconstruction/stereo/plane_sweep.h"

#include "reconstruction/stereo/semi_global.h"
#include "reconstruction/views/bilinear.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace sheen::reconstruction {
namespace {

constexpr int kReach_px = 3;             // of a window: 7 x 7 pixels
constexpr float kLeastPixels = 9;        // of a window that another view shows
constexpr float kNoise = 2.5F / 255;     // of luma: what varies less correlates with nothing
constexpr std::size_t kLeastOthers = 2;  // that show a window
constexpr float kUnseenCost = 0.9F;      // of 0 (alike) to 1 (unlike)
constexpr float kMostCost = 0.4F;        // of a depth that is believed
constexpr float kUnique = 0.06F;         // by which all other depths are worse, of a path's cost
constexpr std::size_t kSameDepth = 2;    // steps

/// What a view shows of a surface: the pixels of a rectangle, row by row.
struct Pixels {
  cv::Rect window;
  std::vector<float> luma;
  std::vector<float> nearest_m;  ///< 0: not on the surface
  std::vector<Eigen::Vector3f> rays;
};

Pixels pixels_of(const StraightView& view, const cv::Mat& nearest) {
  cv::Mat on_surface = nearest > 0;
  Pixels pixels{cv::boundingRect(on_surface), {}, {}, {}};
  const cv::Rect& window = pixels.window;
  for (int y = window.y; y < window.y + window.height; ++y) {
    for (int x = window.x; x < window.x + window.width; ++x) {
      pixels.luma.push_back(view.luma.at<float>(y, x));
      pixels.nearest_m.push_back(nearest.at<float>(y, x));
      pixels.rays.emplace_back(view.ray_of_pixel *
                               Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), 1));
    }
  }
  return pixels;
}

/// Sums over the window round every pixel, in place; windows end at the rectangle's sides.
void sum_windows(const cv::Size& size, std::vector<float>& values, std::vector<float>& scratch) {
  const auto width = static_cast<std::size_t>(size.width);
  for (int y = 0; y < size.height; ++y) {
    float* const sums = scratch.data() + static_cast<std::size_t>(y) * width;
    std::fill_n(sums, width, 0.0F);
    for (int row = std::max(0, y - kReach_px); row <= std::min(size.height - 1, y + kReach_px);
         ++row) {
      const float* const from = values.data() + static_cast<std::size_t>(row) * width;
      for (std::size_t x = 0; x < width; ++x) sums[x] += from[x];
    }
  }
  for (int y = 0; y < size.height; ++y) {
    const float* const from = scratch.data() + static_cast<std::size_t>(y) * width;
    float* const sums = values.data() + static_cast<std::size_t>(y) * width;
    for (int x = 0; x < size.width; ++x) {
      float sum = 0;
      for (int column = std::max(0, x - kReach_px);
           column <= std::min(size.width - 1, x + kReach_px); ++column) {
        sum += from[column];
      }
      sums[x] = sum;
    }
  }
}

/// Another view, and how the rays of a view's pixels go there: in homogeneous pixels.
struct Other {
  const StraightView& view;
  Eigen::Vector3f eye;
  std::vector<Eigen::Vector3f> rays;  ///< per pixel
};

std::vector<Other> seen_from(const Pixels& pixels, const Eigen::Vector3f& eye,
                             const std::vector<const StraightView*>& views) {
  std::vector<Other> others;
  for (const StraightView* view : views) {
    Other other{*view, view->pixel_from_board_turn * eye + view->pixel_from_board_shift, {}};
    for (const auto& ray : pixels.rays) {
      other.rays.emplace_back(view->pixel_from_board_turn * ray);
    }
    others.push_back(std::move(other));
  }
  return others;
}

/// Compares windows of a view with another's at the places where these see a swept surface.
class Correlator {
 public:
  explicit Correlator(const Pixels& pixels) : pixels_(pixels), scratch_(pixels.luma.size()) {
    for (auto& plane : sums_) plane.resize(pixels.luma.size());
  }

  /// Correlations [-1, 1] of all pixels at `depth_m` below their nearest depths, each `stride`
  /// after the one before; -1 where too little is seen.
  void correlate(const Other& other, float depth_m, std::size_t stride, float* correlations) {
    look_up(other, depth_m);
    for (auto& plane : sums_) sum_windows(pixels_.window.size(), plane, scratch_);
    for (std::size_t i = 0; i < scratch_.size(); ++i) correlations[i * stride] = correlation(i);
  }

 private:
  enum Plane : std::size_t { seen, own, others, own_square, others_square, product, planes };

  void look_up(const Other& other, float depth_m) {
    const cv::Mat& luma = other.view.luma;
    const auto right = static_cast<float>(luma.cols - 2);
    const auto bottom = static_cast<float>(luma.rows - 2);
    for (std::size_t i = 0; i < scratch_.size(); ++i) {
      float is_seen = 0;
      float value = 0;
      if (pixels_.nearest_m[i] > 0) {
        const Eigen::Vector3f place = (pixels_.nearest_m[i] + depth_m) * other.rays[i] + other.eye;
        const float x = place.x() / place.z();
        const float y = place.y() / place.z();
        // Windows that reach beyond an outline would compare what stands behind it.
        if (place.z() > 0 && x >= 0 && y >= 0 && x < right && y < bottom &&
            other.view.is_object.at<std::uint8_t>(static_cast<int>(y), static_cast<int>(x)) != 0) {
          value = bilinear_value(luma, x, y);
          is_seen = 1;
        }
      }
      const float own_value = is_seen * pixels_.luma[i];
      sums_[seen][i] = is_seen;
      sums_[own][i] = own_value;
      sums_[others][i] = value;
      sums_[own_square][i] = own_value * own_value;
      sums_[others_square][i] = value * value;
      sums_[product][i] = own_value * value;
    }
  }

  [[nodiscard]] float correlation(std::size_t i) const {
    const float count = sums_[seen][i];
    if (count < kLeastPixels) return -1;
    const float mean = sums_[own][i] / count;
    const float others_mean = sums_[others][i] / count;
    const float variance = std::max(0.0F, sums_[own_square][i] / count - mean * mean);
    const float others_variance =
        std::max(0.0F, sums_[others_square][i] / count - others_mean * others_mean);
    return (sums_[product][i] / count - mean * others_mean) /
           std::sqrt((variance + kNoise * kNoise) * (others_variance + kNoise * kNoise));
  }

  const Pixels& pixels_;
  std::array<std::vector<float>, planes> sums_;
  std::vector<float> scratch_;
};

/// [0, 1] from a window's correlations with all others, which are reordered.
float cost_of(float* correlations, std::size_t count) {
  const std::size_t half = (count + 1) / 2;
  std::partial_sort(correlations, correlations + half, correlations + count, std::greater<>());
  float sum = 0;
  std::size_t seen = 0;
  while (seen < half && correlations[seen] > -1) sum += correlations[seen++];
  if (seen < std::min(kLeastOthers, half)) return kUnseenCost;
  return std::clamp(1 - sum / static_cast<float>(seen), 0.0F, 1.0F);
}

MatchingCosts costs_of(const Pixels& pixels, const Eigen::Vector3f& eye,
                       const std::vector<const StraightView*>& views, const SweptRange& range) {
  const std::vector<Other> others = seen_from(pixels, eye, views);
  const auto steps = static_cast<std::size_t>(range.steps);
  MatchingCosts costs{pixels.window.size(), steps, std::vector<float>(pixels.luma.size() * steps)};
  Correlator correlator(pixels);
  std::vector<float> correlations(pixels.luma.size() * others.size());
  for (std::size_t step = 0; step < steps; ++step) {
    for (std::size_t o = 0; o < others.size(); ++o) {
      correlator.correlate(others[o], static_cast<float>(step) * range.step_m, others.size(),
                           correlations.data() + o);
    }
    for (std::size_t i = 0; i < pixels.luma.size(); ++i) {
      costs.values[i * steps + step] =
          cost_of(correlations.data() + i * others.size(), others.size());
    }
  }
  return costs;
}

/// The step, and parts of one, of the least sum; negative when another one is nearly as small.
float best_step(const float* sums, std::size_t steps) {
  const auto best = static_cast<std::size_t>(std::min_element(sums, sums + steps) - sums);
  float second = std::numeric_limits<float>::infinity();
  for (std::size_t step = 0; step < steps; ++step) {
    if (step + kSameDepth < best || step > best + kSameDepth) second = std::min(second, sums[step]);
  }
  if (second - sums[best] < kUnique * static_cast<float>(kMatchingPaths)) return -1;
  if (best == 0 || best + 1 == steps) return static_cast<float>(best);
  // The parabola through the least sum and its neighbours.
  const float curvature = sums[best - 1] - 2 * sums[best] + sums[best + 1];
  const float shift = curvature > 0 ? 0.5F * (sums[best - 1] - sums[best + 1]) / curvature : 0;
  return std::max(0.0F, static_cast<float>(best) + std::clamp(shift, -0.5F, 0.5F));
}

}  // namespace

cv::Mat sweep_depth(const StraightView& view, const std::vector<const StraightView*>& others,
                    const SweptRange& range) {
  cv::Mat depth(range.nearest.size(), CV_32FC1, cv::Scalar(0));
  const Pixels pixels = pixels_of(view, range.nearest);
  if (pixels.luma.empty() || others.empty()) return depth;
  const MatchingCosts costs = costs_of(pixels, view.project.eye(), others, range);
  const std::vector<float> sums = sum_over_paths(costs, pixels.nearest_m, range.step_m);
  for (std::size_t i = 0; i < pixels.luma.size(); ++i) {
    if (!(pixels.nearest_m[i] > 0)) continue;
    const float step = best_step(sums.data() + i * costs.steps, costs.steps);
    if (step < 0) continue;
    const auto nearest_step = static_cast<std::size_t>(std::lround(step));
    if (costs.values[i * costs.steps + nearest_step] > kMostCost) continue;
    const auto width = static_cast<std::size_t>(pixels.window.width);
    depth.at<float>(pixels.window.y + static_cast<int>(i / width),
                    pixels.window.x + static_cast<int>(i % width)) =
        pixels.nearest_m[i] + step * range.step_m;
  }
  return depth;
}

}  // namespace sheen::reconstruction
