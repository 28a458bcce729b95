// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

namespace sheen::core {

/// Deeper than any file of ours or of other programs nests what is read here. Some parsers recurse,
/// all take hundreds of bytes for a bracket, and copies, comparisons and writers of what they made
/// recurse too: deeper texts are refused before.
inline constexpr std::size_t kMostNesting = 64;

/// How deep brackets nest, wherever they stand: for texts whose form is not known yet, or YAML,
/// whose comments may hold a quotation mark.
std::size_t bracket_depth(std::string_view text);

/// The same of a JSON text, whose strings may hold brackets that mean nothing.
std::size_t json_depth(std::string_view text);

}  // namespace sheen::core
