// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/hull/distance_grid.h"
#include "reconstruction/views/view_set.h"

#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::reconstruction {

/// The visual hull by distances as votes (study, step 4): phi of a point is the `disagreeing`-th
/// largest over the views of its distance from the silhouette's outline, in metres at its depth; so
/// many less one views may be wrong about it. Closed at z = 0. Points that fewer than five views
/// tell something about are outside. `distances` has one image per view. With a `coarse` grid only points nearer to its
/// surface than `band_m` are computed anew, the others are its values.
void carve_hull(const ViewSet& views, const std::vector<cv::Mat>& distances, int disagreeing,
                const DistanceGrid* coarse, float band_m, int threads, DistanceGrid& grid);

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

/// Turns everything but the largest component to the outside.
void keep_largest(const Components& components, DistanceGrid& grid);

}  // namespace sheen::reconstruction
