// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "reconstruction/views/projection.h"

#include <opencv2/core/mat.hpp>

namespace sheen::reconstruction {

/// A mesh as one camera sees it, at the pixels' centres.
struct DepthImage {
  cv::Mat depth;  ///< CV_32FC1, metres along the optical axis; 0 where the mesh is not seen

  /// CV_8UC1, 255 where the mesh is seen.
  [[nodiscard]] cv::Mat mask() const { return depth > 0; }
};

/// Draws the nearest fronts of a mesh (board frame). Triangles that reach behind the camera or
/// beyond the lens model are left out.
DepthImage draw_depth(const core::Mesh& mesh, const Projection& project);

}  // namespace sheen::reconstruction
