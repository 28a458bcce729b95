// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "core/mesh/mesh.h"
#include "reconstruction/object/work_progress.h"
#include "reconstruction/views/view_set.h"

#include <filesystem>
#include <vector>

namespace sheen::reconstruction {

/// The object on a board, from images of a walk round it.
struct ObjectMesh {
  core::Mesh mesh;                ///< closed, manifold, board frame, metres
  std::vector<float> confidence;  ///< per vertex, [0, 1]: how often images showed its rim
  float edge_m = 0;               ///< median length of its edges
  float pixel_m = 0;              ///< size of a pixel at the object, median over the views
  float covered_share = 0;        ///< of the silhouettes' pixels, by the mesh
  float hidden_share = 0;         ///< of the sheet within the tags, never seen
  std::size_t views = 0;
};

/// Measures the shape of the one object that stands on a board's sheet (docs/mesh-from-session.md):
/// the sheet is learned, the object cut out of the images, their silhouettes intersected, the
/// surface moved to where the images show its rims. `session` names the images in errors. Throws
/// core::Error (bad_input) when the images do not tell a shape: seen from too few sides, off the
/// sheet, the sheet hidden, nothing there, several objects, one that moved.
ObjectMesh measure_object(const std::filesystem::path& session, const core::CameraModel& camera,
                          const capture::Board& board, const std::vector<PosedImage>& images,
                          int threads, const WorkProgress& progress);

}  // namespace sheen::reconstruction
