// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace sheen::core {

/// The number that `word` is, all of it, whatever the locale: sign, digits with a decimal point,
/// exponent after e; also nan and inf. What is too small for a double is 0; no value for what is
/// too large, and for anything that is no number.
std::optional<double> parse_number(std::string_view word);

/// The whole number that `word` is, in decimal whatever its leading zeros; no value for anything
/// else.
std::optional<long long> parse_whole_number(std::string_view word);

/// Why `parse_number` takes no value from `word`, to follow the name of the thing in a message:
/// "0,5 has a decimal comma". Long words are cut, bytes that a terminal would take for commands are
/// replaced.
std::string why_no_number(std::string_view word);

/// Whether the word is two groups of digits with a comma between them, such as 0,5.
bool has_decimal_comma(std::string_view word);

/// `text` as it may stand in a message: one line, at most `most` bytes.
std::string quotable(std::string_view text, std::size_t most = 40);

}  // namespace sheen::core
