// SPDX-License-Identifier: MIT
#include "reconstruction/stage/print_check.h"

#include "reconstruction/stage/luma.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sheen::reconstruction {
namespace {

constexpr double kTagWithMargin = 1.5;  // of a tag's side: its black square and some paper
constexpr float kDarkestPaper = 0.6F;   // of the median paper
constexpr float kBrightestPaper = 1.3F;
constexpr float kPaperChroma = 0.07F;  // largest difference of a channel's share
constexpr float kPaperSigma = 0.05F;
constexpr int kGrownTexels = 4;
constexpr float kGuessSigma = 0.045F;

/// Marks the squares of the tags, each grown to `scale` times its side.
cv::Mat tag_squares(const capture::Board& board, const PlaneGrid& grid, double scale) {
  cv::Mat marked(grid.size, CV_8UC1, cv::Scalar(0));
  for (const auto& [id, tag] : board.tags) {
    const auto corners = tag.corners_in_board();
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const auto& corner : corners) centre += corner / 4;
    std::array<cv::Point, 4> polygon;
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector3d grown = centre + scale * (corners[i] - centre);
      const Eigen::Vector2f texel = grid.texel_of(grown.head<2>().cast<float>());
      polygon[i] = {static_cast<int>(std::lround(texel.x())),
                    static_cast<int>(std::lround(texel.y()))};
    }
    cv::fillConvexPoly(marked, polygon.data(), 4, cv::Scalar(255));
  }
  return marked;
}

cv::Mat region_mask(const capture::Board& board, const PlaneGrid& grid) {
  const Eigen::AlignedBox2f region = tags_region(board);
  const Eigen::Vector2f least = grid.texel_of(region.min());
  const Eigen::Vector2f most = grid.texel_of(region.max());
  cv::Mat mask(grid.size, CV_8UC1, cv::Scalar(0));
  const cv::Point first(static_cast<int>(std::ceil(least.x())),
                        static_cast<int>(std::ceil(least.y())));
  const cv::Point last(static_cast<int>(std::floor(most.x())),
                       static_cast<int>(std::floor(most.y())));
  cv::rectangle(mask, first, last, cv::Scalar(255), cv::FILLED);
  return mask;
}

cv::Vec3f shares_of(const cv::Vec3f& bgr) {
  return bgr * (1 / std::max(bgr[0] + bgr[1] + bgr[2], 1e-3F));
}

/// Colour of the paper: medians over what is seen between the tags.
std::optional<cv::Vec3f> paper_colour_within(const StageMap& map, const cv::Mat& between) {
  constexpr std::size_t fewest = 50;
  std::array<std::vector<double>, 3> values;
  for (int y = 0; y < map.colour.rows; ++y) {
    for (int x = 0; x < map.colour.cols; ++x) {
      if (between.at<std::uint8_t>(y, x) == 0 || map.source.at<std::uint8_t>(y, x) == 0) continue;
      for (int c = 0; c < 3; ++c) {
        values[static_cast<std::size_t>(c)].push_back(
            static_cast<double>(map.colour.at<cv::Vec3f>(y, x)[c]));
      }
    }
  }
  if (values[0].size() < fewest) return std::nullopt;
  cv::Vec3f paper;
  for (std::size_t c = 0; c < 3; ++c) {
    // The upper quartile, since the object may fill much of the place between the tags.
    const auto place = values[c].begin() + static_cast<std::ptrdiff_t>(values[c].size() * 7 / 10);
    std::nth_element(values[c].begin(), place, values[c].end());
    paper[static_cast<int>(c)] = static_cast<float>(*place);
  }
  return paper;
}

}  // namespace

Eigen::AlignedBox2f tags_region(const capture::Board& board) {
  Eigen::AlignedBox2f box;
  for (const auto& [id, tag] : board.tags) {
    for (const auto& corner : tag.corners_in_board()) box.extend(corner.head<2>().cast<float>());
  }
  return box;
}

std::optional<cv::Vec3f> paper_colour(const capture::Board& board, const StageMap& map) {
  return paper_colour_within(map,
                             region_mask(board, map.grid) & ~tag_squares(board, map.grid, 1.1));
}

bool looks_like_paper(const cv::Vec3f& colour, const cv::Vec3f& paper) {
  const float ratio = luma_of(colour) / std::max(luma_of(paper), 1e-3F);
  const cv::Vec3f chroma = shares_of(colour) - shares_of(paper);
  return ratio > kDarkestPaper && ratio < kBrightestPaper &&
         std::max({std::abs(chroma[0]), std::abs(chroma[1]), std::abs(chroma[2])}) < kPaperChroma;
}

void refuse_what_is_no_print(const capture::Board& board, StageMap& map) {
  const cv::Mat between =
      region_mask(board, map.grid) & ~tag_squares(board, map.grid, kTagWithMargin);
  const auto paper = paper_colour_within(map, between);
  if (!paper) return;
  cv::Mat refused(map.grid.size, CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < between.rows; ++y) {
    for (int x = 0; x < between.cols; ++x) {
      if (between.at<std::uint8_t>(y, x) == 0 || map.source.at<std::uint8_t>(y, x) == 0) continue;
      if (map.sigma.at<float>(y, x) < kPaperSigma &&
          looks_like_paper(map.colour.at<cv::Vec3f>(y, x), *paper)) {
        continue;
      }
      refused.at<std::uint8_t>(y, x) = 255;
    }
  }
  const int side = 2 * kGrownTexels + 1;
  cv::dilate(refused, refused, cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side}));
  map.source.setTo(static_cast<double>(TexelSource::unknown), refused);
}

void inpaint_hidden_paper(const capture::Board& board, StageMap& map) {
  const cv::Mat region = region_mask(board, map.grid);
  const auto paper = paper_colour(board, map);
  if (!paper) return;

  // Spread the paper's colours into what is hidden, from fine to coarse.
  cv::Mat weight(map.grid.size, CV_32FC1, cv::Scalar(0));
  cv::Mat colour(map.grid.size, CV_32FC3, cv::Scalar::all(0));
  for (int y = 0; y < weight.rows; ++y) {
    for (int x = 0; x < weight.cols; ++x) {
      if (map.source.at<std::uint8_t>(y, x) != static_cast<std::uint8_t>(TexelSource::seen))
        continue;
      const auto& seen = map.colour.at<cv::Vec3f>(y, x);
      if (luma_of(seen) < 0.35F * luma_of(*paper)) continue;
      weight.at<float>(y, x) = 1;
      colour.at<cv::Vec3f>(y, x) = seen;
    }
  }
  const cv::Mat hidden = region & (map.source == static_cast<double>(TexelSource::unknown));
  cv::Mat open = hidden.clone();
  for (int side = 9; cv::countNonZero(open) > 0 && side < 4 * weight.cols; side = 2 * side + 1) {
    cv::Mat near_weight;
    cv::Mat near_colour;
    cv::boxFilter(weight, near_weight, CV_32F, {side, side}, {-1, -1}, false, cv::BORDER_CONSTANT);
    cv::boxFilter(colour, near_colour, CV_32F, {side, side}, {-1, -1}, false, cv::BORDER_CONSTANT);
    for (int y = 0; y < weight.rows; ++y) {
      for (int x = 0; x < weight.cols; ++x) {
        if (open.at<std::uint8_t>(y, x) == 0) continue;
        const float w = near_weight.at<float>(y, x);
        if (w < 0.1F * static_cast<float>(side)) continue;
        map.colour.at<cv::Vec3f>(y, x) = near_colour.at<cv::Vec3f>(y, x) * (1 / w);
        open.at<std::uint8_t>(y, x) = 0;
      }
    }
  }
  map.sigma.setTo(static_cast<double>(kGuessSigma), hidden);
  map.source.setTo(static_cast<double>(TexelSource::inpainted), hidden & ~open);
}

}  // namespace sheen::reconstruction
