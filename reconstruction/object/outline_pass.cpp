// SPDX-License-Identifier: MIT
#include "reconstruction/object/outline_pass.h"

#include "core/concurrency/parallel_for.h"
#include "reconstruction/silhouette/segmentation.h"
#include "reconstruction/stage/print_check.h"

#include <algorithm>

namespace sheen::reconstruction {
namespace {

constexpr float kStageMargin = 0.35F;   // of the tags' extent, learned beyond it
constexpr float kObjectMargin = 0.05F;  // and where an object is looked for

Eigen::AlignedBox2f tags_and(float margin, const capture::Board& board) {
  const Eigen::AlignedBox2f tags = tags_region(board);
  const Eigen::Vector2f margin_m = margin * tags.sizes();
  return {tags.min() - margin_m, tags.max() + margin_m};
}

}  // namespace

Eigen::AlignedBox2f stage_region(const capture::Board& board) {
  return tags_and(kStageMargin, board);
}

Eigen::AlignedBox2f object_region(const capture::Board& board) {
  return tags_and(kObjectMargin, board);
}

int one_in(std::size_t share, std::size_t views) {
  return std::clamp(static_cast<int>(views / share), 1, 24);
}

std::vector<Silhouette> cut_out_all(const LearnedStage& stage, const ViewSet& views,
                                    const std::vector<cv::Mat>& masks, OutlineDetail detail,
                                    int threads, std::string_view step,
                                    const WorkProgress& progress) {
  std::vector<Silhouette> silhouettes(views.views.size());
  // In batches, so that progress is told by the thread that called.
  const auto batch = static_cast<std::size_t>(std::max(1, 2 * threads));
  for (std::size_t first = 0; first < silhouettes.size(); first += batch) {
    const std::size_t count = std::min(batch, silhouettes.size() - first);
    core::parallel_for(
        count, threads,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t v = first + begin; v < first + end; ++v) {
            silhouettes[v] = cut_out(stage, views, v, masks.empty() ? cv::Mat() : masks[v], detail);
            if (detail == OutlineDetail::pixels) silhouettes[v].background.colour.release();
          }
        },
        1);
    progress(step, static_cast<int>(first + count), static_cast<int>(silhouettes.size()));
  }
  return silhouettes;
}

std::vector<OutlineVote> votes_of(const std::vector<Silhouette>& silhouettes) {
  std::vector<OutlineVote> votes;
  for (const Silhouette& silhouette : silhouettes) {
    votes.push_back({silhouette.distance,
                     silhouette.background.source == static_cast<double>(TexelSource::inpainted)});
  }
  return votes;
}

float paper_share(const capture::Board& board, const LearnedStage& stage, const ViewSet& views,
                  const std::vector<Silhouette>& silhouettes) {
  const auto paper = paper_colour(board, stage.map);
  if (!paper) return 0;
  std::size_t all = 0;
  std::size_t like_paper = 0;
  for (std::size_t v = 0; v < silhouettes.size(); ++v) {
    const cv::Vec3f exposed = paper->mul(stage.gains[v]);
    const cv::Mat& labels = silhouettes[v].labels;
    for (int y = 0; y < labels.rows; ++y) {
      for (int x = 0; x < labels.cols; ++x) {
        if (labels.at<std::uint8_t>(y, x) != static_cast<std::uint8_t>(PixelLabel::object))
          continue;
        const cv::Vec3f colour = cv::Vec3f(views.views[v].image.at<cv::Vec3b>(y, x)) * (1.0F / 255);
        ++all;
        like_paper += looks_like_paper(colour, exposed) ? 1 : 0;
      }
    }
  }
  return all == 0 ? 0 : static_cast<float>(like_paper) / static_cast<float>(all);
}

}  // namespace sheen::reconstruction
