// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/surface_points.h"
#include "core/samples/vertex_view.h"
#include "core/visibility/depth_image.h"
#include "fitting/kept_views/kept_view.h"
#include "fitting/multi_eigenspace/picture_frame.h"

#include <opencv2/core/mat.hpp>

namespace sheen::fitting::multi_eigenspace {

/// Makes pictures of photographs: what each shows on the billboard that faces its camera. Keeps its
/// storage from view to view.
class Rectifier {
 public:
  /// Copies what it needs from the mesh.
  Rectifier(const core::Mesh& mesh, int threads);

  /// CV_8UC4 of `side_px` x `side_px`: blue, green, red, and the part of a pixel that the mesh
  /// covers. Colours go on smoothly beyond the outline, so that pictures can be mixed without the
  /// background showing and without division by the coverage. Nothing but grey where the mesh is
  /// not seen at all.
  cv::Mat picture(const KeptView& view, const PictureFrame& frame, int side_px);

 private:
  cv::Mat mask_of(const KeptView& view);

  core::SurfacePoints points_;
  core::DepthImage depth_;
  core::VertexView view_;
  int threads_;
};

}  // namespace sheen::fitting::multi_eigenspace
