// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "reconstruction/hull/visual_hull.h"
#include "reconstruction/stage/stage_map.h"
#include "reconstruction/views/view_set.h"

#include <filesystem>

namespace sheen::reconstruction {

/// What makes a shape untellable, each with what to film instead. All throw core::Error (bad_input)
/// that names `session`.

/// Some side is seen by no view across: silhouettes say nothing of the depth there.
void refuse_narrow_range(const std::filesystem::path& session, const capture::Board& board,
                         const ViewSet& views);

/// Share of the texels within the board's tags that no view shows, and refuses when that is most.
float refuse_hidden_sheet(const std::filesystem::path& session, const capture::Board& board,
                          const StageMap& map);

/// No component at all.
void refuse_empty_sheet(const std::filesystem::path& session, const Components& components);

/// More than one object, or one that stands beside the tags. There is at least one component.
void refuse_what_stands_there(const std::filesystem::path& session, const capture::Board& board,
                              const Components& components);

/// One that stands beside the tags.
void refuse_beside_tags(const std::filesystem::path& session, const capture::Board& board,
                        const Component& object);

/// Most of what was cut out looks like paper: only asked when no shape came of it.
void refuse_paper_like(const std::filesystem::path& session, float paper_share);

/// What both halves of a walk show does not overlap: the object moved.
void refuse_two_places(const std::filesystem::path& session, const Component& first,
                       const Component& second);

/// Silhouettes that the hull, which all of them share, leaves bare: the object moved.
void refuse_moved_object(const std::filesystem::path& session, float covered_share);

}  // namespace sheen::reconstruction
