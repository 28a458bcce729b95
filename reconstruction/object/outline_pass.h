// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "reconstruction/hull/visual_hull.h"
#include "reconstruction/object/work_progress.h"
#include "reconstruction/silhouette/cut_out.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <string_view>
#include <vector>

namespace sheen::reconstruction {

/// The part of the plane that is learned: the tags' and beyond, board frame, metres.
Eigen::AlignedBox2f stage_region(const capture::Board& board);

/// The part of it above which an object is looked for.
Eigen::AlignedBox2f object_region(const capture::Board& board);

/// One view in so many may be wrong where the stage is only guessed.
inline constexpr std::size_t kOneGuessIn = 6;

/// Votes that may be wrong when one view in `share` may, of so many views; at least 1.
int one_in(std::size_t share, std::size_t views);

/// Cuts the object out of every view. `masks` may be empty (cut_out.h).
std::vector<Silhouette> cut_out_all(const LearnedStage& stage, const ViewSet& views,
                                    const std::vector<cv::Mat>& masks, OutlineDetail detail,
                                    int threads, std::string_view step,
                                    const WorkProgress& progress);

/// What these outlines say of points in space.
std::vector<OutlineVote> votes_of(const std::vector<Silhouette>& silhouettes);

/// Share of what was cut out that looks like the sheet's paper, in the open or in shade; 0 where
/// too little paper is seen to tell.
float paper_share(const capture::Board& board, const LearnedStage& stage, const ViewSet& views,
                  const std::vector<Silhouette>& silhouettes);

}  // namespace sheen::reconstruction
