// SPDX-License-Identifier: MIT
#include "pipeline/check_seen.h"

#include "core/diagnostics/error.h"

#include <fmt/format.h>

namespace sheen::pipeline {

void check_something_was_seen(const capture::Session& session, const FrameStatistics& frames,
                              std::size_t samples) {
  if (frames.posed.empty()) {
    std::string reasons;
    for (const auto& [reason, count] : frames.pose_rejections) {
      reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, reason);
    }
    throw core::bad_input(
        session.folder,
        fmt::format("none of {} frames got a pose ({})", frames.frames_read, reasons),
        "check that board.yaml describes the printed board and that the board is "
        "in view and sharp");
  }
  if (samples == 0) {
    throw core::bad_input(session.mesh, "is not seen in any posed frame",
                          "check T_stage_object and that mesh and board are in metres");
  }
}

}  // namespace sheen::pipeline
