// SPDX-License-Identifier: MIT
#include "reconstruction/stage/stage_map.h"

#include "core/concurrency/parallel_for.h"
#include "core/numerics/median.h"
#include "reconstruction/stage/luma.h"
#include "reconstruction/views/bilinear.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sheen::reconstruction {
namespace {

constexpr std::size_t kFewestSamples = 4;
constexpr std::size_t kOneFreeIn =
    4;  // of the views of a texel: fewer may show the object after all
constexpr float kSmallestSpread = 0.012F;  // of a mode: noise of a camera with JPEG
constexpr float kReach = 2.5F;             // of the mode, in spreads
constexpr float kDarkest = 0.2F;           // luma of texels that tell an exposure

struct Sample {
  float luma;
  cv::Vec3f colour;
};

/// The shortest interval of luma that holds a share of the samples, which are sorted here.
struct Mode {
  float centre, width;
};

Mode find_mode(std::vector<Sample>& samples, float share) {
  std::sort(samples.begin(), samples.end(),
            [](const Sample& a, const Sample& b) { return a.luma < b.luma; });
  const auto count = std::max<std::size_t>(
      2, static_cast<std::size_t>(std::ceil(share * static_cast<float>(samples.size()))));
  std::size_t best = 0;
  float width = samples.back().luma - samples.front().luma + 1;
  for (std::size_t i = 0; i + count <= samples.size(); ++i) {
    const float w = samples[i + count - 1].luma - samples[i].luma;
    if (w < width) {
      width = w;
      best = i;
    }
  }
  return {0.5F * (samples[best].luma + samples[best + count - 1].luma), width};
}

/// Reads one texel in every view that shows it; returns how many there are, hidden ones too.
std::size_t gather(const ViewSet& views, const std::vector<ViewGain>& gains,
                   const MapLearning& learning, const Eigen::Vector3f& point,
                   std::vector<Sample>& samples) {
  samples.clear();
  std::size_t views_of_texel = 0;
  for (std::size_t v = 0; v < views.views.size(); ++v) {
    const View& view = views.views[v];
    const auto pixel = view.project(point);
    if (!pixel || !view.project.in_image(pixel, 1)) continue;
    ++views_of_texel;
    if (!learning.masks.empty() &&
        learning.masks[v].at<std::uint8_t>(static_cast<int>(std::lround(pixel.y_px)),
                                           static_cast<int>(std::lround(pixel.x_px))) != 0) {
      continue;
    }
    const cv::Vec3f read = bilinear_bgr(view.image, pixel.x_px, pixel.y_px);
    const cv::Vec3f colour(read[0] / gains[v][0], read[1] / gains[v][1], read[2] / gains[v][2]);
    samples.push_back({luma_of(colour), colour});
  }
  return views_of_texel;
}

struct Texel {
  cv::Vec3f colour;
  float sigma;
};

Texel summarise(std::vector<Sample>& samples, float mode_share) {
  const Mode mode = find_mode(samples, mode_share);
  const float reach = std::max(kReach * std::max(mode.width, kSmallestSpread), 0.6F * mode.width);
  cv::Vec3f sum(0, 0, 0);
  cv::Vec3f squares(0, 0, 0);
  float count = 0;
  for (const Sample& sample : samples) {
    if (std::abs(sample.luma - mode.centre) > reach) continue;
    sum += sample.colour;
    squares += sample.colour.mul(sample.colour);
    count += 1;
  }
  const cv::Vec3f mean = sum * (1 / count);
  float variance = 0;
  for (int c = 0; c < 3; ++c)
    variance += std::max(0.0F, squares[c] / count - mean[c] * mean[c]) / 3;
  return {mean, std::sqrt(variance)};
}

}  // namespace

PlaneGrid plane_grid(const ViewSet& views, const Eigen::AlignedBox2f& region, double most_texels) {
  std::vector<double> px_m;
  const Eigen::Vector2f centre = region.center();
  for (const View& view : views.views) {
    const auto pixel = view.project({centre.x(), centre.y(), 0});
    if (pixel) px_m.push_back(1.0 / static_cast<double>(view.project.px_per_m(pixel.depth_m)));
  }
  const Eigen::Vector2f size_m = region.sizes();
  const double area_m2 = static_cast<double>(size_m.x()) * static_cast<double>(size_m.y());
  const double smallest = std::sqrt(area_m2 / most_texels);
  const double texel_m = px_m.empty() ? smallest : std::max(smallest, core::upper_median(px_m));
  PlaneGrid grid;
  grid.texel_m = static_cast<float>(texel_m);
  grid.first_m = region.min();
  grid.size = cv::Size(1 + static_cast<int>(size_m.x() / grid.texel_m),
                       1 + static_cast<int>(size_m.y() / grid.texel_m));
  return grid;
}

StageMap learn_stage_map(const ViewSet& views, const std::vector<ViewGain>& gains,
                         const PlaneGrid& grid, const MapLearning& learning, int threads) {
  StageMap map{grid, cv::Mat(grid.size, CV_32FC3, cv::Scalar::all(0)),
               cv::Mat(grid.size, CV_32FC1, cv::Scalar(0)),
               cv::Mat(grid.size, CV_8UC1, cv::Scalar(0))};
  const auto learn_rows = [&](std::size_t begin, std::size_t end) {
    std::vector<Sample> samples;
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
      for (int column = 0; column < grid.size.width; ++column) {
        const Eigen::Vector2f place =
            grid.point_of(static_cast<float>(column), static_cast<float>(row));
        const std::size_t shown =
            gather(views, gains, learning, {place.x(), place.y(), 0}, samples);
        if (samples.size() < std::max(kFewestSamples, shown / kOneFreeIn)) continue;
        const Texel texel = summarise(samples, learning.mode_share);
        map.colour.at<cv::Vec3f>(row, column) = texel.colour;
        map.sigma.at<float>(row, column) = texel.sigma;
        map.source.at<std::uint8_t>(row, column) = static_cast<std::uint8_t>(TexelSource::seen);
      }
    }
  };
  core::parallel_for(static_cast<std::size_t>(grid.size.height), threads, learn_rows, 4);
  return map;
}

std::vector<ViewGain> estimate_gains(const ViewSet& views, const StageMap& map,
                                     const std::vector<cv::Mat>& masks, int threads) {
  constexpr int stride = 3;
  constexpr std::size_t fewest = 200;
  std::vector<ViewGain> gains(views.views.size(), ViewGain(1, 1, 1));
  const auto estimate = [&](std::size_t v) {
    const View& view = views.views[v];
    std::array<std::vector<double>, 3> ratios;
    for (int row = 0; row < map.grid.size.height; row += stride) {
      for (int column = 0; column < map.grid.size.width; column += stride) {
        if (map.source.at<std::uint8_t>(row, column) == 0) continue;
        const auto& expected = map.colour.at<cv::Vec3f>(row, column);
        if (luma_of(expected) < kDarkest) continue;
        const Eigen::Vector2f place =
            map.grid.point_of(static_cast<float>(column), static_cast<float>(row));
        const auto pixel = view.project({place.x(), place.y(), 0});
        if (!pixel || !view.project.in_image(pixel, 1)) continue;
        if (!masks.empty() && masks[v].at<std::uint8_t>(static_cast<int>(pixel.y_px),
                                                        static_cast<int>(pixel.x_px)) != 0) {
          continue;
        }
        const cv::Vec3f read = bilinear_bgr(view.image, pixel.x_px, pixel.y_px);
        for (int c = 0; c < 3; ++c) {
          ratios[static_cast<std::size_t>(c)].push_back(
              static_cast<double>(read[c] / std::max(expected[c], 0.05F)));
        }
      }
    }
    if (ratios[0].size() < fewest) return;
    for (std::size_t c = 0; c < 3; ++c) {
      gains[v][static_cast<int>(c)] =
          std::clamp(static_cast<float>(core::upper_median(ratios[c])), 0.3F, 3.0F);
    }
  };
  core::parallel_for(
      gains.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) estimate(v);
      },
      1);
  return gains;
}

}  // namespace sheen::reconstruction
