// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sheen::capture {

/// Whether the sizes of the tags fit their places: neighbours that neither overlap nor stand sixty
/// sizes apart. Returns what is doubtful, one line each; throws core::Error (bad_input) for what
/// cannot be. `path` is that of board.yaml.
std::vector<std::string> check_tag_layout(const Board& board, const std::filesystem::path& path);

/// Whether tags of this size can be a print at all; as above.
std::vector<std::string> check_tag_size(const Board& board, const std::filesystem::path& path);

/// Both.
std::vector<std::string> check_board(const Board& board, const std::filesystem::path& path);

/// Middle size of the tags, metres; 0 without tags.
double typical_tag_m(const Board& board);

/// Distance between the farthest corners of the box round all tags, metres.
double board_extent_m(const Board& board);

}  // namespace sheen::capture
