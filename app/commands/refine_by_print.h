// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "core/mesh/mesh.h"
#include "pipeline/progress_sink.h"
#include "reconstruction/object/object_mesh.h"

#include <vector>

namespace sheen::app {

/// How the object's print moved a mesh.
struct PrintRefinement {
  int rounds = 0;            ///< that views which had no part in them confirmed; 0: it stays
  double residual_left = 1;  ///< on those views, of what it was before
};

/// Moves the vertices of a mesh in the board's frame to where the pictures of the object's print
/// agree (docs/mesh-from-session.md, step 6), as long as views that have no part in it confirm that
/// clearly and the surface still crosses itself nowhere.
PrintRefinement refine_by_print(const capture::Session& session,
                                const std::vector<reconstruction::PosedImage>& images, int threads,
                                pipeline::ProgressSink& sink, core::Mesh& mesh);

}  // namespace sheen::app
