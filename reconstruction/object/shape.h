// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "reconstruction/hull/visual_hull.h"
#include "reconstruction/views/view_set.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <filesystem>
#include <vector>

namespace sheen::reconstruction {

/// What was found of the object so far.
struct Shape {
  DistanceGrid grid;
  Eigen::AlignedBox3f box;  ///< of its inside

  /// The box with `share` of its longest side and two cells more on every side.
  [[nodiscard]] Eigen::AlignedBox3f grown(float share) const;
};

/// Above a part of the sheet (board frame, metres), below every camera: where an object may be.
Eigen::AlignedBox3f space_above(const Eigen::AlignedBox2f& region, const ViewSet& views);

/// Where each view sees a shape, grown a little (CV_8UC1 per view).
std::vector<cv::Mat> masks_of(const Shape& shape, const ViewSet& views, int threads);

/// What stands on the sheet; the rest of the grid's inside is turned to the outside.
Components standing_in(DistanceGrid& grid);

/// While the sheet is half known, pieces of it may float about: the largest piece that stands on it
/// and does not go on beyond the grid, and others of nearly its size; they are gone after the next
/// pass, or are objects, too. Throws core::Error (bad_input) that names `session` when
/// there is none.
Shape likeliest_shape(const std::filesystem::path& session, DistanceGrid grid);

/// The one object that stands on the sheet. Throws core::Error (bad_input) that names `session`
/// when there is none, more than one, or one beside the tags.
Shape only_shape(const std::filesystem::path& session, const capture::Board& board,
                 DistanceGrid grid);

}  // namespace sheen::reconstruction
