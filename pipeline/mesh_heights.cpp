// SPDX-License-Identifier: MIT
#include "pipeline/mesh_heights.h"

#include "core/mesh/bounds.h"
#include "pipeline/hold_out.h"
#include "pipeline/texel_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace sheen::pipeline {
namespace {

using fitting::heights::PosedImage;

constexpr std::size_t kMostStills = 64;
constexpr std::size_t kMostBytes = std::size_t{512} << 20;
constexpr std::size_t kCheckEvery = 4;

std::size_t most_views(const core::CameraModel& camera) {
  const std::size_t bytes = 3 * static_cast<std::size_t>(camera.width_px()) *
                            static_cast<std::size_t>(camera.height_px());
  return std::clamp<std::size_t>(kMostBytes / std::max<std::size_t>(1, bytes), 2, kMostStills);
}

/// At most `most` posed frames of those that are fitted, evenly spread over the recording, whose
/// length need not be known: of the frames that come every stride-th is kept, and when there are
/// too many, every other one of them is dropped.
std::vector<PosedImage> spread_images(const capture::Session& session, const FrameChoice& choice,
                                      std::size_t most, PoseStage& poses, ProgressSink& sink) {
  const HoldOut hold_out{choice.hold_out};
  std::vector<PosedImage> images;
  const auto frames = static_cast<std::size_t>(std::max(0, poses.frame_count().value_or(0)));
  std::size_t stride = std::max<std::size_t>(1, (frames + most - 1) / most);
  std::size_t fitted = 0;
  const auto is_wanted = [&](const capture::Frame& frame) {
    return !hold_out.contains(frame.index) && fitted++ % stride == 0;
  };
  while (const auto tracked = poses.next(is_wanted)) {
    const auto* const pose = std::get_if<capture::FramePose>(&tracked->pose);
    if (pose == nullptr) continue;
    images.push_back({tracked->frame.image, &session.camera_of(tracked->frame.index),
                      pose->camera_from_board * session.board_from_object});
    sink.progress({"refining the mesh, reading", static_cast<int>(images.size())});
    if (images.size() <= most) continue;
    for (std::size_t i = 0; 2 * i < images.size(); ++i) std::swap(images[i], images[2 * i]);
    images.resize((images.size() + 1) / 2);
    stride *= 2;
  }
  return images;
}

}  // namespace

MeshRefinement refine_mesh_heights(const core::Mesh& mesh, const std::vector<PosedImage>& images,
                                   fitting::heights::Outlines outlines, int threads,
                                   ProgressSink& sink) {
  std::vector<PosedImage> views, check_views;
  std::vector<Eigen::Isometry3d> from;
  const std::size_t count = std::min(kMostStills, images.size());
  for (std::size_t i = 0; i < count; ++i) {
    const PosedImage& image = images[i * images.size() / count];
    from.push_back(image.camera_from_object);
    const bool is_check = from.size() % kCheckEvery == kCheckEvery / 2;
    (is_check ? check_views : views).push_back(image);
  }
  MeshRefinement result{.mesh = mesh, .views = views.size(), .check_views = check_views.size()};
  if (views.size() < 2 || check_views.empty()) {
    sink.note(fmt::format("{} frames are too few to refine the mesh, it stays as it is",
                          views.size() + check_views.size()));
    return result;
  }
  const double texel_m = pixel_footprint_m(from, core::bounds_of(mesh).center().cast<double>(),
                                           views[0].camera->intrinsics().focal_px.x());
  auto refined =
      fitting::heights::refine_heights(mesh, views, check_views, static_cast<float>(texel_m),
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

MeshRefinement refine_mesh_heights(const capture::Session& session, const core::Mesh& mesh,
                                   const FrameChoice& choice, PoseStage& poses, int threads,
                                   ProgressSink& sink) {
  return refine_mesh_heights(
      mesh, spread_images(session, choice, most_views(session.camera), poses, sink),
      fitting::heights::Outlines::may_move, threads, sink);
}

}  // namespace sheen::pipeline
