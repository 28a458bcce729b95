// SPDX-License-Identifier: MIT
#include "reconstruction/object/coarse_pass.h"

#include "reconstruction/object/outline_pass.h"

#include <array>
#include <string>

namespace sheen::reconstruction {
namespace {

constexpr float kRoomAround = 0.3F;  // the shape before: of its longest side

CarvingVotes votes_of_pass(int pass, std::size_t views) {
  constexpr std::array<std::size_t, kCoarsePasses> shares{8, 12, 20, 24, 24};
  return {.wrong = one_in(shares[static_cast<std::size_t>(pass)], views),
          .guesses_wrong = one_in(kOneGuessIn, views)};
}

}  // namespace

CoarseHull carve_coarsely(const capture::Board& board, const ViewSet& views,
                          const CoarseGrids& grids, int pass, const Shape* before, int threads,
                          const WorkProgress& progress) {
  const auto masks = before == nullptr ? std::vector<cv::Mat>() : masks_of(*before, views, threads);
  LearnedStage stage = learn_stage(board, views, grids.stage, masks, threads);
  const auto silhouettes = cut_out_all(stage, views, masks, OutlineDetail::pixels, threads,
                                       "outlines, pass " + std::to_string(pass + 1), progress);
  Eigen::AlignedBox3f box = space_above(grids.region, views);
  if (before != nullptr) box = box.intersection(before->grown(kRoomAround));
  const float cell_m = box.sizes().maxCoeff() / static_cast<float>(grids.cells);
  box.min().z() = -cell_m;
  DistanceGrid grid(box, box.sizes().maxCoeff() / static_cast<float>(grids.cells), 1);
  carve_hull(views, votes_of(silhouettes), votes_of_pass(pass, views.views.size()), nullptr, 0,
             threads, grid);
  grid.cut_below(0);
  const float like_paper = paper_share(board, stage, views, silhouettes);
  return {std::move(grid), std::move(stage.map), like_paper};
}

}  // namespace sheen::reconstruction
