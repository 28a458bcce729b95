// SPDX-License-Identifier: MIT
#include "pipeline/light/session_light.h"

#include "core/diagnostics/error.h"
#include "pipeline/light/recording_light.h"
#include "pipeline/session_parts.h"

#include <fmt/format.h>

#include <vector>

namespace sheen::pipeline {
namespace {

constexpr int kProbes = 12;
constexpr int kSupposedFrames = 600;  // of recordings that do not say how many they have

/// Of the frames that are posed and show tags.
std::vector<std::vector<capture::PaperLight>> look_at_frames(const capture::Session& session,
                                                             const FrameChoice& choice,
                                                             const capture::PaperReader& paper) {
  const auto estimator = make_pose_estimator(session, choice.pose_source, choice.gate);
  const auto frames = capture::open_frames(session, choice.start, choice.end);
  const int count = frames->frame_count().value_or(kSupposedFrames);
  std::vector<std::vector<capture::PaperLight>> lights;
  int passed = 0;
  for (int probe = 0; probe < kProbes; ++probe) {
    for (; passed < count * (2 * probe + 1) / (2 * kProbes); ++passed) {
      if (!frames->skip()) return lights;
    }
    const auto frame = frames->next();
    ++passed;
    if (!frame) break;
    const auto result = estimator->estimate(*frame);
    const auto* pose = std::get_if<capture::FramePose>(&result);
    if (pose == nullptr) continue;
    lights.push_back(paper.read(frame->image, pose->camera_from_board));
  }
  return lights;
}

}  // namespace

std::optional<capture::PaperReader> paper_reader(const capture::Session& session) {
  if (!session.board) return std::nullopt;
  try {
    return capture::PaperReader(capture::read_board(*session.board), session.camera);
  } catch (const core::Error&) {
    return std::nullopt;
  }
}

void complete_light(capture::Session& session, const FrameChoice& choice, ProgressSink& sink) {
  const auto paper = paper_reader(session);
  if (!paper) return;
  const auto light = solve_light(look_at_frames(session, choice, *paper));
  if (!light || !clearly_changes(*light)) return;
  session.paper_light = light->usual;
  sink.note(fmt::format(
      "{}: by the paper around the tags {}; images are levelled by it. Lock both in the camera: "
      "what one exposure saturates is lost",
      session.folder.string(), describe(light->change)));
}

}  // namespace sheen::pipeline
