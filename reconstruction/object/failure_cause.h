// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "reconstruction/views/view_set.h"

#include <filesystem>

namespace sheen::reconstruction {

/// After no shape came of a walk: looks for the cause where the passes towards a shape do not look.
/// Throws core::Error (bad_input) that names it: an object that looks like its sheet
/// (`paper_share`, of what was cut out last), one that stands beside the tags, one that stands
/// elsewhere in the second half of the walk. Returns where it is none of these.
void refuse_by_cause(const std::filesystem::path& session, const capture::Board& board,
                     const ViewSet& views, float paper_share, int threads);

}  // namespace sheen::reconstruction
