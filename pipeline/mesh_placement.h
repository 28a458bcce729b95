// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "pipeline/evidence/finding.h"
#include "pipeline/mesh_stills.h"
#include "pipeline/progress_sink.h"

#include <Eigen/Core>

#include <optional>
#include <string_view>
#include <vector>

namespace sheen::pipeline {

/// A mesh of another size than the object or beside its place, put right. docs/algorithm.md, 12.
struct MeshPlacement {
  core::Mesh mesh;                                    ///< put right
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  ///< of its middle, object frame
  double growth = 0;                                  ///< 0.01: made one per cent larger
  double residual_change = 0;  ///< of its print on check views, a part: -0.33 is a third less

  /// Says what was found, what becomes of it (`outcome`), and what the user should look at.
  [[nodiscard]] Finding finding(std::string_view outcome) const;
};

/// Outcome where the light field is fitted to MeshPlacement::mesh.
inline constexpr std::string_view kIsPutRight = "the light field is fitted to the mesh put there";

/// Places `mesh` by the object's outlines in the images, where that is clearly another place or
/// size and where its print agrees better there: the difference of views that are left out to the
/// mean picture of the others falls by fitting::heights::kClearFall. A mesh that is surely of
/// another size is placed also where that difference hardly changes. Nothing where the mesh stays:
/// none of this, outlines of another shape, an object that moved, or fewer than six views.
std::optional<MeshPlacement> place_mesh(const core::Mesh& mesh,
                                        const std::vector<PosedImage>& images, int threads,
                                        ProgressSink& sink);

}  // namespace sheen::pipeline
