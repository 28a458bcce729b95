// SPDX-License-Identifier: MIT
#include "pipeline/mesh_heights.h"

#include <fmt/format.h>

#include <utility>

namespace sheen::pipeline {

MeshRefinement refine_mesh_heights(const core::Mesh& mesh, const std::vector<PosedImage>& images,
                                   fitting::heights::Outlines outlines, int threads,
                                   ProgressSink& sink) {
  const DividedStills stills(images);
  MeshRefinement result{
      .mesh = mesh, .views = stills.views.size(), .check_views = stills.check_views.size()};
  if (stills.views.size() < 2 || stills.check_views.empty()) {
    sink.note(fmt::format("{} frames are too few to refine the mesh, it stays as it is",
                          result.views + result.check_views));
    return result;
  }
  auto refined =
      fitting::heights::refine_heights(mesh, stills.views, stills.check_views, stills.texel_m(mesh),
                                       outlines, threads, [&](int done, int all) {
                                         sink.progress({"refining the mesh", done, all});
                                       });
  if (!(refined.residual_before > 0)) {
    sink.note("the frames show too little of the mesh to refine it, it stays as it is");
  }
  result.mesh = std::move(refined.mesh);
  result.is_accepted = refined.is_accepted;
  result.median_mm = 1000 * refined.median_m;
  result.residual_change = refined.change();
  return result;
}

}  // namespace sheen::pipeline
