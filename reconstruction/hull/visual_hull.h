// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/hull/distance_grid.h"
#include "reconstruction/views/view_set.h"

#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::reconstruction {

/// What one view says.
struct OutlineVote {
  cv::Mat distance;    ///< CV_32FC1, px from the outline, positive outside
  cv::Mat is_guessed;  ///< CV_8UC1, not 0: the stage behind is only guessed
};

/// How many views may be wrong about a point.
struct CarvingVotes {
  int wrong = 1;          ///< the k-th largest distance counts, k >= 1
  int guesses_wrong = 1;  ///< >= wrong: the same, where distances before a guessed stage count, too
  float blur_px = 0;      ///< above 0: within it of an outline one more view has to agree
};

/// The visual hull by distances as votes (study, step 4): phi of a point is the k-th largest over
/// the views of its distance from the silhouette's outline, in metres at its depth; so k - 1 views
/// may be wrong about it, more where the stage is guessed. The outlines that carve farthest are
/// those that lie wrong: nearer to them than `blur_px` one view is not enough. Closed at z = 0.
/// Points that fewer than a quarter of the views tell something about are outside. `outlines` has
/// one entry per view. With a `coarse` grid only points nearer to its surface than `band_m` are
/// computed anew, the others are its values.
void carve_hull(const ViewSet& views, const std::vector<OutlineVote>& outlines,
                const CarvingVotes& votes, const DistanceGrid* coarse, float band_m, int threads,
                DistanceGrid& grid);

/// A connected part of the inside of a grid.
struct Component {
  std::size_t points = 0;
  Eigen::AlignedBox3f box;  ///< board frame, metres
};

/// Components of the inside (phi < 0, six neighbours), the largest first, and for every grid point
/// its component's index; -1 outside.
struct Components {
  std::vector<Component> parts;
  std::vector<int> of_point;
};
Components find_components(const DistanceGrid& grid);

/// The same after components that nowhere come below `foot_m` have been turned to the outside: what
/// does not stand on the sheet is a phantom.
Components find_standing(float foot_m, DistanceGrid& grid);

/// Turns everything but some components to the outside.
void keep_components(const Components& components, const std::vector<int>& kept,
                     DistanceGrid& grid);

}  // namespace sheen::reconstruction
