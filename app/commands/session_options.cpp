// SPDX-License-Identifier: MIT
#include "app/commands/session_options.h"

#include "app/interrupt.h"
#include "app/pipeline/hold_out.h"
#include "core/diagnostics/error.h"

#include <fmt/format.h>

#include <map>

namespace sheen::app {

void add_session_options(CLI::App& command, SessionOptions& options) {
  command.add_option("--start", options.start, "First frame")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--end", options.end, "One past the last frame (default: all)")
      ->check(CLI::PositiveNumber);
  const std::map<std::string, PoseSource> sources{
      {"auto", PoseSource::automatic}, {"tags", PoseSource::tags}, {"file", PoseSource::file}};
  command
      .add_option("--pose-source", options.pose_source,
                  "auto: the session's poses.txt if it has one, else the tags (default auto)")
      ->transform(CLI::CheckedTransformer(sources, CLI::ignore_case).description("auto|tags|file"));
  command.add_option("--min-tags", options.gate.min_tags, "Refuse frames with fewer known tags")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--max-reprojection", options.gate.max_reprojection_px,
                  "Refuse frames whose joint pose fits worse, px RMS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--max-blur", options.gate.max_blur_px,
                  "Refuse frames whose tag edges are wider, px")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

std::vector<PosedFrame> pose_frames(const capture::Session& session, const SessionOptions& options,
                                    const std::function<void(int frames_read)>& on_frame) {
  const auto frames = capture::open_frames(session, options.start, options.end);
  const auto poses = make_pose_estimator(session, options.pose_source, options.gate);
  const HoldOut hold_out{options.hold_out};
  std::vector<PosedFrame> posed;
  int frames_read = 0;
  while (const auto frame = frames->next()) {
    throw_if_interrupted();
    on_frame(++frames_read);
    if (options.hold_out > 0 && !hold_out.contains(frame->index)) continue;
    const auto result = poses->estimate(*frame);
    if (const auto* pose = std::get_if<capture::FramePose>(&result)) {
      posed.push_back({frame->index, frame->time_s, pose->camera_from_board});
    }
  }
  if (posed.empty()) {
    throw core::bad_input(options.folder, fmt::format("none of {} frames got a pose", frames_read),
                          "sheen replay tells why frames are refused");
  }
  return posed;
}

}  // namespace sheen::app
