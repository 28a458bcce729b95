// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/heights/refine_heights.h"
#include "pipeline/mesh_stills.h"
#include "pipeline/progress_sink.h"

#include <cstddef>
#include <vector>

namespace sheen::pipeline {

/// What became of a session's mesh when its vertices were to be moved to where the pictures agree.
struct MeshRefinement {
  core::Mesh mesh;  ///< refined where accepted, else as given
  bool is_accepted = false;
  double median_mm = 0;        ///< of the moves, whether or not they were accepted
  double residual_change = 0;  ///< on the check views, a part: -0.33 is a third less
  std::size_t views = 0;       ///< that heights were estimated from
  std::size_t check_views = 0;
};

/// Refines `mesh` (fitting/heights/refine_heights.h) from images that DividedStills divides. Where
/// nothing can be said, the mesh stays, with a note.
MeshRefinement refine_mesh_heights(const core::Mesh& mesh, const std::vector<PosedImage>& images,
                                   fitting::heights::Outlines outlines, int threads,
                                   ProgressSink& sink);

}  // namespace sheen::pipeline
