// SPDX-License-Identifier: MIT
#include "reconstruction/object/outline_pass.h"

#include "core/concurrency/parallel_for.h"
#include "reconstruction/stage/print_check.h"

#include <algorithm>

namespace sheen::reconstruction {
namespace {

constexpr float kStageMargin = 0.35F;  // of the tags' extent, learned beyond it

}  // namespace

Eigen::AlignedBox2f stage_region(const capture::Board& board) {
  const Eigen::AlignedBox2f tags = tags_region(board);
  const Eigen::Vector2f margin = kStageMargin * tags.sizes();
  return {tags.min() - margin, tags.max() + margin};
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

}  // namespace sheen::reconstruction
