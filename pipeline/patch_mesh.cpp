// SPDX-License-Identifier: MIT
#include "pipeline/patch_mesh.h"

#include "core/mesh/bounds.h"
#include "core/mesh/refine_mesh.h"
#include "pipeline/texel_size.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <vector>

namespace sheen::pipeline {
namespace {

constexpr int kReadFrames = 90;
constexpr int kProbedFrames = 9;  // of those read: poses from tags take their time
constexpr std::size_t kMostPatches = 2'000'000;

}  // namespace

std::optional<double> pixel_footprint_m(const capture::Session& session, const core::Mesh& mesh,
                                        capture::PoseEstimator& poses) {
  std::vector<Eigen::Isometry3d> camera_from_object;
  const auto frames = capture::open_frames(session, 0, kReadFrames);
  const int stride = std::max(
      1, std::min(frames->frame_count().value_or(kReadFrames), kReadFrames) / kProbedFrames);
  for (int i = 0; const auto frame = frames->next(); ++i) {
    if (i % stride != 0 && !camera_from_object.empty()) continue;
    const auto result = poses.estimate(*frame);
    if (const auto* pose = std::get_if<capture::FramePose>(&result)) {
      camera_from_object.push_back(pose->camera_from_board * session.board_from_object);
    }
  }
  if (camera_from_object.empty()) return std::nullopt;
  return pixel_footprint_m(camera_from_object, core::bounds_of(mesh).center().cast<double>(),
                           session.camera.intrinsics().focal_px.x());
}

core::Mesh texel_mesh(const core::Mesh& mesh, double pixel_footprint_m, double spacing_px) {
  return core::refine_mesh(mesh, static_cast<float>(pixel_footprint_m * spacing_px), kMostPatches);
}

}  // namespace sheen::pipeline
