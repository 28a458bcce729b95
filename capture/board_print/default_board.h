// SPDX-License-Identifier: MIT
#pragma once

#include "capture/board_print/board_plan.h"
#include "capture/pose/tag_detector.h"
#include "capture/source/frame.h"
#include "core/geometry/camera.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace sheen::capture {

/// The sheets that need no board.yaml: what `sheen board` prints when nothing else is asked for.
/// Their ids tell them from each other and from other boards, whose ids begin at 0
/// (docs/session-format.md lists them).
struct DefaultSheet {
  std::string_view paper;  ///< of kPapers
  int first_id;
};
inline constexpr std::array<DefaultSheet, 2> kDefaultSheets{{{"a4", 500}, {"letter", 540}}};

/// The sheet whose design this is, whatever its first id; nothing for any other design.
std::optional<DefaultSheet> default_sheet_of(const BoardDesign& design);

/// The sheet's tags at the size printed at 100 %.
Board default_board(const DefaultSheet& sheet);

/// All tags of all default sheets, each sheet's around the origin: for finding them in an image,
/// not for posing.
Board all_default_tags();

/// The sheet of which most of `tags` are, in any number of images; nothing when none is.
std::optional<DefaultSheet> recognise_default_sheet(const std::vector<TagDetection>& tags);

/// One of a session's first images, which shows none of the default sheets' tags: throws
/// core::Error (bad_input) that names `session` when it shows another board's.
void refuse_other_board(const std::filesystem::path& session, const core::CameraModel& camera,
                        const Frame& frame);

}  // namespace sheen::capture
