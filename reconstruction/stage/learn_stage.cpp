// SPDX-License-Identifier: MIT
#include "reconstruction/stage/learn_stage.h"

#include "reconstruction/stage/hidden_paper.h"
#include "reconstruction/stage/print_check.h"

namespace sheen::reconstruction {
namespace {

constexpr float kShareWithObject = 0.2F;  // of the samples in the mode: 35 % mix the object in
constexpr float kShareWithoutObject = 0.6F;

}  // namespace

LearnedStage learn_stage(const capture::Board& board, const ViewSet& views, const PlaneGrid& grid,
                         const std::vector<cv::Mat>& masks, int threads) {
  const MapLearning learning{masks.empty() ? kShareWithObject : kShareWithoutObject, masks};
  LearnedStage stage;
  stage.gains.assign(views.views.size(), ViewGain(1, 1, 1));
  stage.map = learn_stage_map(views, stage.gains, grid, learning, threads);
  stage.gains = estimate_gains(views, stage.map, masks, threads);
  stage.map = learn_stage_map(views, stage.gains, grid, learning, threads);
  refuse_what_is_no_print(board, stage.map);
  if (masks.empty()) return stage;
  inpaint_hidden_paper(board, stage.map);
  learn_hidden_paper(board, views, stage.gains, stage.map, threads);
  return stage;
}

}  // namespace sheen::reconstruction
