// SPDX-License-Identifier: MIT
#include "app/commands/frame_options.h"

namespace sheen::app {

void add_frame_options(Command command, pipeline::FrameChoice& choice) {
  using pipeline::PoseSource;
  command.option("--start", choice.start, "First frame").not_negative().show_default();
  command.option("--end", choice.end, "One past the last frame (default: all)").positive();
  command.choice<PoseSource>(
      "--pose-source", choice.pose_source,
      {{"auto", PoseSource::automatic}, {"tags", PoseSource::tags}, {"file", PoseSource::file}},
      "auto: the session's poses.txt if it has one, else the tags");
  command.option("--min-tags", choice.gate.min_tags, "Refuse frames with fewer known tags")
      .positive()
      .show_default();
  command
      .option("--max-reprojection", choice.gate.max_reprojection_px,
              "Refuse frames whose joint pose fits worse, px RMS")
      .positive()
      .show_default();
  command
      .option("--max-blur", choice.gate.max_blur_px, "Refuse frames whose tag edges are wider, px")
      .positive()
      .show_default();
}

void add_evaluated_frame_options(Command command, pipeline::FrameChoice& choice) {
  command
      .option("--hold-out", choice.hold_out,
              "Only the frames that replay --hold-out N kept out; 0: all")
      .not_negative()
      .show_default();
  add_frame_options(command, choice);
}

}  // namespace sheen::app
