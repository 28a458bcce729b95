// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "core/mesh/mesh.h"
#include "fitting/heights/refine_heights.h"
#include "fitting/heights/seen_texels.h"
#include "pipeline/options.h"
#include "pipeline/pose_stage.h"
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

/// Refines `mesh` (fitting/heights/refine_heights.h) from at most 64 of these images, spread
/// evenly; every fourth of them is a check view. Where nothing can be said, the mesh stays, with a
/// note.
MeshRefinement refine_mesh_heights(const core::Mesh& mesh,
                                   const std::vector<fitting::heights::PosedImage>& images,
                                   fitting::heights::Outlines outlines, int threads,
                                   ProgressSink& sink);

/// The same from frames of a session that `choice` fits, of a mesh whose outlines may move: those
/// that are held out have no part in it. Their images stay in memory, of large ones fewer are
/// taken: at most 512 MiB. Poses are taken as they come from `poses`, frames without one are passed
/// over.
MeshRefinement refine_mesh_heights(const capture::Session& session, const core::Mesh& mesh,
                                   const FrameChoice& choice, PoseStage& poses, int threads,
                                   ProgressSink& sink);

}  // namespace sheen::pipeline
