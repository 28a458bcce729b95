// SPDX-License-Identifier: MIT
#include "reconstruction/stereo/proven_carving.h"

#include "core/concurrency/parallel_for.h"
#include "reconstruction/hull/visual_hull.h"
#include "reconstruction/surface/marching_tetrahedra.h"
#include "reconstruction/views/bilinear.h"
#include "reconstruction/views/depth_image.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace sheen::reconstruction {
namespace {

constexpr std::size_t kPredictors = 4;  // views that a pixel is predicted from
constexpr float kPredictorCosine =
    0.87F;                          // of the angle to them, 30 degrees: stereo asked nearer views
constexpr float kSameDepth_px = 2;  // of a point and the surface in a view that sees it
constexpr float kMissed = 0.25F;    // of luma: a pixel before which nothing is left
constexpr double kClearlyBetter = 0.9;  // of the squares that the hull leaves
constexpr int kLeastJudged = 20;        // that judge a region
constexpr int kReach_cells = 2;         // of a region's values beyond it

/// What the judges say about a region: sums over their pixels of squared differences of luma.
struct Verdict {
  double hull = 0;
  double carved = 0;
  int pixels = 0;
};

/// How deep each view sees the hull.
std::vector<cv::Mat> hull_depths(const DepthMaps& maps) {
  std::vector<cv::Mat> depths;
  for (const StraightView& view : maps.views) depths.push_back(view.hull);
  return depths;
}

/// How deep each view sees the surface of a grid.
std::vector<cv::Mat> depths_of(const DepthMaps& maps, const DistanceGrid& grid, int threads) {
  const core::Mesh surface = march_tetrahedra(grid);
  std::vector<cv::Mat> depths(maps.views.size());
  core::parallel_for(
      depths.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          depths[v] = draw_depth(surface, maps.views[v].project).depth;
        }
      },
      1);
  return depths;
}

/// Predicts pixels of a judge from the views beside it that see the same place of a surface.
class Predictor {
 public:
  Predictor(const DepthMaps& maps, std::size_t judge, const Eigen::Vector3f& centre) : maps_(maps) {
    const auto direction = [&](std::size_t v) -> Eigen::Vector3f {
      return (maps.views[v].project.eye() - centre).normalized();
    };
    for (std::size_t v = 0; v < maps.views.size(); ++v) {
      if (!is_judge(v)) order_.push_back(v);
    }
    std::ranges::stable_sort(order_, std::greater<>(),
                             [&](std::size_t v) { return direction(judge).dot(direction(v)); });
  }

  /// Luma of a point of the surface; nothing when fewer than two of the views see it.
  [[nodiscard]] std::optional<float> luma(const std::vector<cv::Mat>& depths,
                                          const Eigen::Vector3f& point) const {
    float sum = 0;
    std::size_t count = 0;
    for (const std::size_t v : order_) {
      const StraightView& view = maps_.views[v];
      const auto seen = view.project(point);
      if (!seen || !view.project.in_image(seen, 1)) continue;
      const float depth_m = depths[v].at<float>(static_cast<int>(std::lround(seen.y_px)),
                                                static_cast<int>(std::lround(seen.x_px)));
      if (std::abs(depth_m - seen.depth_m) > kSameDepth_px * maps_.pixel_m) continue;
      sum += bilinear_value(view.luma, seen.x_px, seen.y_px);
      if (++count == kPredictors) break;
    }
    if (count < 2) return std::nullopt;
    return sum / static_cast<float>(count);
  }

 private:
  const DepthMaps& maps_;
  std::vector<std::size_t> order_;  ///< views that judge nothing, the best predictors first
};

/// The region that a ray crosses first between two depths; negative: none.
int region_between(const Components& regions, const DistanceGrid& grid, const Eigen::Vector3f& eye,
                   const Eigen::Vector3f& ray, float from_m, float to_m) {
  for (float depth_m = from_m; depth_m < to_m; depth_m += 0.5F * grid.cell_m()) {
    const Eigen::Vector3f cell = grid.cell_of(eye + depth_m * ray);
    const Eigen::Array3i place = cell.array().round().cast<int>();
    if ((place < 0).any() || (place >= grid.size()).any()) continue;
    const int region = regions.of_point[grid.index(place.x(), place.y(), place.z())];
    if (region >= 0) return region;
  }
  return -1;
}

float square(float value) {
  return value * value;
}

/// Adds what one judge says of the regions.
void judge(const DepthMaps& maps, std::size_t v, const Components& regions,
           const DistanceGrid& grid, const std::vector<cv::Mat>& hull,
           const std::vector<cv::Mat>& carved, std::vector<Verdict>& verdicts) {
  const StraightView& view = maps.views[v];
  const Predictor predictor(maps, v, grid.box().center());
  const float farthest_m = grid.box().diagonal().norm();
  for (int y = 0; y < view.is_object.rows; ++y) {
    for (int x = 0; x < view.is_object.cols; ++x) {
      if (view.is_object.at<std::uint8_t>(y, x) == 0) continue;
      const float above_m = hull[v].at<float>(y, x);
      const float below_m = carved[v].at<float>(y, x);
      const bool is_lost = !(below_m > 0);
      if (!(above_m > 0) || (!is_lost && below_m - above_m < maps.pixel_m)) continue;
      const Eigen::Vector3f ray =
          view.ray_of_pixel * Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), 1);
      const Eigen::Vector3f eye = view.project.eye();
      const int region = region_between(regions, grid, eye, ray, above_m,
                                        is_lost ? above_m + farthest_m : below_m);
      if (region < 0) continue;
      const auto by_hull = predictor.luma(hull, eye + above_m * ray);
      const auto by_carved = is_lost ? std::nullopt : predictor.luma(carved, eye + below_m * ray);
      if (!by_hull || (!is_lost && !by_carved)) continue;
      const float luma = view.luma.at<float>(y, x);
      Verdict& verdict = verdicts[static_cast<std::size_t>(region)];
      verdict.hull += static_cast<double>(square(*by_hull - luma));
      verdict.carved += static_cast<double>(is_lost ? square(kMissed) : square(*by_carved - luma));
      ++verdict.pixels;
    }
  }
}

/// What lies in a kept region or next to one.
std::vector<bool> near_kept(const DistanceGrid& grid, const Components& regions,
                            const std::vector<bool>& is_kept) {
  std::vector<bool> near(grid.count());
  const Eigen::Array3i& size = grid.size();
  for (int z = 0; z < size.z(); ++z) {
    for (int y = 0; y < size.y(); ++y) {
      for (int x = 0; x < size.x(); ++x) {
        const int region = regions.of_point[grid.index(x, y, z)];
        if (region < 0 || !is_kept[static_cast<std::size_t>(region)]) continue;
        for (int k = std::max(0, z - kReach_cells); k <= std::min(size.z() - 1, z + kReach_cells);
             ++k) {
          for (int j = std::max(0, y - kReach_cells); j <= std::min(size.y() - 1, y + kReach_cells);
               ++j) {
            for (int i = std::max(0, x - kReach_cells);
                 i <= std::min(size.x() - 1, x + kReach_cells); ++i) {
              near[grid.index(i, j, k)] = true;
            }
          }
        }
      }
    }
  }
  return near;
}

}  // namespace

void keep_proven_carving(const DepthMaps& maps, const DistanceGrid& hull, int threads,
                         DistanceGrid& carved) {
  DistanceGrid gone = hull;
  for (std::size_t i = 0; i < gone.count(); ++i) {
    gone[i] = hull[i] < 0 && carved[i] >= 0 ? -1.0F : 1.0F;
  }
  const Components regions = find_components(gone);
  const std::vector<cv::Mat> above = hull_depths(maps);
  const std::vector<cv::Mat> below = depths_of(maps, carved, threads);
  std::vector<std::vector<Verdict>> by_view(maps.views.size());
  core::parallel_for(
      by_view.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          if (!is_judge(v)) continue;
          by_view[v].resize(regions.parts.size());
          judge(maps, v, regions, hull, above, below, by_view[v]);
        }
      },
      1);
  std::vector<bool> is_kept(regions.parts.size());
  for (std::size_t r = 0; r < is_kept.size(); ++r) {
    Verdict all;
    for (const auto& verdicts : by_view) {
      if (verdicts.empty()) continue;
      all.hull += verdicts[r].hull;
      all.carved += verdicts[r].carved;
      all.pixels += verdicts[r].pixels;
    }
    is_kept[r] = all.pixels >= kLeastJudged && all.carved < kClearlyBetter * all.hull;
  }
  const std::vector<bool> near = near_kept(hull, regions, is_kept);
  for (std::size_t i = 0; i < carved.count(); ++i) {
    const int region = regions.of_point[i];
    const bool is_undone = region >= 0 && !is_kept[static_cast<std::size_t>(region)];
    if (is_undone || !near[i]) carved[i] = hull[i];
  }
}

}  // namespace sheen::reconstruction
