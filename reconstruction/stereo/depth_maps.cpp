// SPDX-License-Identifier: MIT
#include "reconstruction/stereo/depth_maps.h"

#include "core/concurrency/parallel_for.h"
#include "core/mesh/bounds.h"
#include "core/numerics/median.h"
#include "reconstruction/stereo/plane_sweep.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace sheen::reconstruction {
namespace {

constexpr float kStep_px = 1.5F;     // moves a window by less than one at the angles below
constexpr float kInFront_steps = 2;  // of the hull, which outlines may have carved too far
constexpr float kDeepest = 0.3F;     // below the hull, of the object's longest side
constexpr int kMostSteps = 72;       // bounds time and memory
constexpr float kBestAngle = 14;     // degrees between neighbours, as the object sees them
constexpr float kLeastAngle = 3;
constexpr float kMostAngle = 40;
constexpr std::size_t kMostNeighbours = 6;
constexpr std::size_t kLeastNeighbours = 3;
constexpr int kConfirmed = 3;       // by so many other depths
constexpr float kSamePlace_px = 2;  // along the line of sight
constexpr float kDegrees = 180 / std::numbers::pi_v<float>;

/// The views that look from about the best angle beside a view.
std::vector<const StraightView*> neighbours(const std::vector<StraightView>& views, std::size_t of,
                                            const Eigen::Vector3f& centre) {
  const auto direction = [&](std::size_t v) {
    return (views[v].project.eye() - centre).normalized();
  };
  std::vector<std::pair<float, std::size_t>> order;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const float cosine = std::clamp(direction(of).dot(direction(v)), -1.0F, 1.0F);
    const float angle = kDegrees * std::acos(cosine);
    if (v == of || is_judge(v) || angle < kLeastAngle || angle > kMostAngle) continue;
    order.emplace_back(std::abs(angle - kBestAngle), v);
  }
  std::ranges::sort(order);
  std::vector<const StraightView*> chosen;
  for (const auto& [off, v] : order) {
    if (chosen.size() < kMostNeighbours) chosen.push_back(&views[v]);
  }
  return chosen;
}

cv::Mat depth_below(const std::vector<StraightView>& views, std::size_t v,
                    const Eigen::AlignedBox3f& box, float pixel_m) {
  const StraightView& view = views[v];
  const auto others = neighbours(views, v, box.center());
  if (is_judge(v) || others.size() < kLeastNeighbours)
    return cv::Mat(view.hull.size(), CV_32FC1, cv::Scalar(0));
  SweptRange range;
  range.step_m = kStep_px * pixel_m;
  range.nearest = view.hull - kInFront_steps * range.step_m;
  range.nearest.setTo(0, view.is_object == 0);
  const float deepest_steps = kDeepest * box.sizes().maxCoeff() / range.step_m;
  range.steps = std::clamp(static_cast<int>(kInFront_steps + deepest_steps), 1, kMostSteps);
  return sweep_depth(view, others, range);
}

/// A view's depths that enough others have, too.
cv::Mat confirmed(const DepthMaps& maps, const std::vector<cv::Mat>& swept, std::size_t of) {
  cv::Mat depth = swept[of].clone();
  const StraightView& view = maps.views[of];
  for (int y = 0; y < depth.rows; ++y) {
    auto* row = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (!(row[x] > 0)) continue;
      const Eigen::Vector3f pixel(static_cast<float>(x), static_cast<float>(y), 1);
      const Eigen::Vector3f point = view.project.eye() + row[x] * (view.ray_of_pixel * pixel);
      int agreeing = 0;
      for (std::size_t v = 0; v < swept.size(); ++v) {
        if (v == of || is_judge(v)) continue;
        const auto seen = maps.views[v].project(point);
        if (!seen || !maps.views[v].project.in_image(seen, 0)) continue;
        const float other = swept[v].at<float>(static_cast<int>(std::lround(seen.y_px)),
                                               static_cast<int>(std::lround(seen.x_px)));
        if (other > 0 && std::abs(other - seen.depth_m) < kSamePlace_px * maps.pixel_m) ++agreeing;
      }
      if (agreeing < kConfirmed) row[x] = 0;
    }
  }
  return depth;
}

}  // namespace

DepthMaps find_depths(const ViewSet& views, const core::Mesh& hull, int threads,
                      const WorkProgress& progress) {
  DepthMaps maps;
  maps.views = straighten(views, hull, threads);
  const std::size_t count = maps.views.size();
  const Eigen::AlignedBox3f box = core::bounds_of(hull);
  std::vector<double> pixels_m;
  for (const StraightView& view : maps.views) {
    const auto seen = view.project(box.center());
    if (seen) pixels_m.push_back(1 / static_cast<double>(view.project.px_per_m(seen.depth_m)));
  }
  maps.depth.resize(count);
  if (pixels_m.empty()) return maps;
  maps.pixel_m = static_cast<float>(core::upper_median(pixels_m));
  std::vector<cv::Mat> swept(count);
  // In batches, so that progress is told by the thread that called.
  const auto batch = static_cast<std::size_t>(std::max(1, 2 * threads));
  for (std::size_t first = 0; first < count; first += batch) {
    const std::size_t some = std::min(batch, count - first);
    core::parallel_for(
        some, threads,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t v = first + begin; v < first + end; ++v) {
            swept[v] = depth_below(maps.views, v, box, maps.pixel_m);
          }
        },
        1);
    progress("depths by stereo", static_cast<int>(first + some), static_cast<int>(count));
  }
  core::parallel_for(
      count, threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) maps.depth[v] = confirmed(maps, swept, v);
      },
      1);
  return maps;
}

}  // namespace sheen::reconstruction
