// SPDX-License-Identifier: MIT
#include "pipeline/mesh_stills.h"

#include "core/mesh/bounds.h"
#include "pipeline/evidence/corner_evidence.h"
#include "pipeline/hold_out.h"
#include "pipeline/texel_size.h"

#include <algorithm>
#include <utility>

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostStills = 64;
constexpr std::size_t kMostBytes = std::size_t{512} << 20;
constexpr std::size_t kCheckEvery = 4;

}  // namespace

std::size_t most_stills(const core::CameraModel& camera) {
  const std::size_t bytes = 3 * static_cast<std::size_t>(camera.width_px()) *
                            static_cast<std::size_t>(camera.height_px());
  return std::clamp<std::size_t>(kMostBytes / std::max<std::size_t>(1, bytes), 2, kMostStills);
}

// The length need not be known: of the frames that come every stride-th is kept, and when there are
// too many, every other one of them is dropped.
std::vector<PosedImage> read_stills(const capture::Session& session, const FrameChoice& choice,
                                    PoseStage& poses, ProgressSink& sink) {
  const std::size_t most = most_stills(session.camera);
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
    sink.progress({"measuring the mesh, reading", static_cast<int>(images.size())});
    if (images.size() <= most) continue;
    for (std::size_t i = 0; 2 * i < images.size(); ++i) std::swap(images[i], images[2 * i]);
    images.resize((images.size() + 1) / 2);
    stride *= 2;
  }
  return images;
}

bool are_poses_sound(const capture::Session& session, const std::optional<capture::Board>& board,
                     const std::vector<PosedImage>& images, ProgressSink& sink) {
  if (!board) return true;
  CornerEvidence corners(*board, session.camera, {}, 1);
  const Eigen::Isometry3d object_from_board = session.board_from_object.inverse();
  for (const PosedImage& image : images) {
    corners.look_at({.image = image.image}, image.camera_from_object * object_from_board, {});
  }
  const bool are_sound = corners.findings().empty();
  if (!are_sound) {
    sink.note("the tags' corners show that poses are wrong, so the mesh stays as it is");
  }
  return are_sound;
}

DividedStills::DividedStills(const std::vector<PosedImage>& images) {
  const std::size_t count = std::min(kMostStills, images.size());
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_check = (i + 1) % kCheckEvery == kCheckEvery / 2;
    (is_check ? check_views : views).push_back(images[i * images.size() / count]);
  }
}

float DividedStills::texel_m(const core::Mesh& mesh) const {
  std::vector<Eigen::Isometry3d> from;
  for (const auto* images : {&views, &check_views}) {
    for (const PosedImage& image : *images) from.push_back(image.camera_from_object);
  }
  return static_cast<float>(pixel_footprint_m(from, core::bounds_of(mesh).center().cast<double>(),
                                              views[0].camera->intrinsics().focal_px.x()));
}

}  // namespace sheen::pipeline
