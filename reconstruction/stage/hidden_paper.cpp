// SPDX-License-Identifier: MIT
#include "reconstruction/stage/hidden_paper.h"

#include "core/concurrency/parallel_for.h"
#include "reconstruction/stage/luma.h"
#include "reconstruction/stage/print_check.h"
#include "reconstruction/views/bilinear.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sheen::reconstruction {
namespace {

constexpr std::size_t kFewestAgreeing = 4;
constexpr std::size_t kOneAgreeingIn = 10;  // of the views of a texel
constexpr float kAgreement = 0.05F;         // of the light on the paper
constexpr float kDeepestLight = 0.2F;       // of that in the open,
constexpr float kBrightestLight = 1.1F;     // that paper can have
constexpr float kLargestHue = 0.035F;       // what paper's colour does not explain, of its light

/// Light on paper of a colour, 1 in the open; nothing where the hue says that it is no paper.
std::optional<float> light_on_paper(const cv::Vec3f& colour, const cv::Vec3f& paper) {
  const float light = colour.dot(paper) / paper.dot(paper);
  if (light < kDeepestLight || light > kBrightestLight) return std::nullopt;
  const cv::Vec3f rest = colour - light * paper;
  const float most = kLargestHue * std::max(light, 0.4F);
  if (rest.dot(rest) > most * most) return std::nullopt;
  return light;
}

struct PaperSample {
  float light;
  cv::Vec3f colour;
};

/// The largest group of samples whose light differs by less than kAgreement.
std::pair<std::size_t, std::size_t> largest_group(std::vector<PaperSample>& samples) {
  std::sort(samples.begin(), samples.end(),
            [](const PaperSample& a, const PaperSample& b) { return a.light < b.light; });
  std::pair<std::size_t, std::size_t> best{0, 0};
  for (std::size_t first = 0, end = 0; first < samples.size(); ++first) {
    while (end < samples.size() && samples[end].light - samples[first].light <= kAgreement) ++end;
    if (end - first > best.second - best.first) best = {first, end};
  }
  return best;
}

}  // namespace

void learn_hidden_paper(const capture::Board& board, const ViewSet& views,
                        const std::vector<ViewGain>& gains, StageMap& map, int threads) {
  const auto paper = paper_colour(board, map);
  if (!paper) return;
  const Eigen::AlignedBox2f region = tags_region(board);
  const auto learn_rows = [&](std::size_t begin, std::size_t end) {
    std::vector<PaperSample> samples;
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
      for (int column = 0; column < map.grid.size.width; ++column) {
        auto& source = map.source.at<std::uint8_t>(row, column);
        if (source == static_cast<std::uint8_t>(TexelSource::seen)) continue;
        const Eigen::Vector2f place =
            map.grid.point_of(static_cast<float>(column), static_cast<float>(row));
        if (!region.contains(place)) continue;
        samples.clear();
        std::size_t shown = 0;
        for (std::size_t v = 0; v < views.views.size(); ++v) {
          const View& view = views.views[v];
          const auto pixel = view.project({place.x(), place.y(), 0});
          if (!pixel || !view.project.in_image(pixel, 1)) continue;
          ++shown;
          const cv::Vec3f read = bilinear_bgr(view.image, pixel.x_px, pixel.y_px);
          const cv::Vec3f colour(read[0] / gains[v][0], read[1] / gains[v][1],
                                 read[2] / gains[v][2]);
          if (const auto light = light_on_paper(colour, *paper))
            samples.push_back({*light, colour});
        }
        const auto [first, last] = largest_group(samples);
        const std::size_t agreeing = last - first;
        if (agreeing < std::max(kFewestAgreeing, shown / kOneAgreeingIn)) continue;
        cv::Vec3f sum(0, 0, 0);
        for (std::size_t i = first; i < last; ++i) sum += samples[i].colour;
        map.colour.at<cv::Vec3f>(row, column) = sum * (1 / static_cast<float>(agreeing));
        map.sigma.at<float>(row, column) = kAgreement / 2;
        source = static_cast<std::uint8_t>(TexelSource::seen);
      }
    }
  };
  core::parallel_for(static_cast<std::size_t>(map.grid.size.height), threads, learn_rows, 4);
}

}  // namespace sheen::reconstruction
