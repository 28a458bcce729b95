// SPDX-License-Identifier: MIT
#include "app/commands/refine_by_print.h"

#include "pipeline/mesh_heights.h"
#include "reconstruction/surface/untangle.h"

#include <algorithm>
#include <utility>

namespace sheen::app {
namespace {

constexpr int kMostRounds = 4;
constexpr double kClearFall = 0.05;  // of the residual: gloss is taken for smaller ones

}  // namespace

PrintRefinement refine_by_print(const capture::Session& session,
                                const std::vector<reconstruction::PosedImage>& images, int threads,
                                pipeline::ProgressSink& sink, core::Mesh& mesh) {
  std::vector<fitting::heights::PosedImage> views;
  for (const auto& image : images) {
    views.push_back({image.image, &session.camera_of(image.frame_index), image.camera_from_board});
  }
  PrintRefinement result;
  while (result.rounds < kMostRounds) {
    auto refined =
        pipeline::refine_mesh_heights(mesh, views, fitting::heights::Outlines::stay, threads, sink);
    if (!refined.is_accepted || refined.residual_change > -kClearFall) break;
    for (Eigen::Vector3f& position : refined.mesh.positions) {
      position.z() = std::max(position.z(), 0.0F);  // the sheet carries the object
    }
    if (!reconstruction::untangle(refined.mesh, threads)) break;
    mesh = std::move(refined.mesh);
    result.residual_left *= 1 + refined.residual_change;
    ++result.rounds;
  }
  return result;
}

}  // namespace sheen::app
