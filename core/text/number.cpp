// SPDX-License-Identifier: MIT
#include "core/text/number.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <system_error>

namespace sheen::core {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Of a number that no double holds: whether it is too small and not too large.
bool underflows(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  if (exponent != std::string_view::npos) return word.substr(exponent + 1).starts_with('-');
  // Without an exponent a number out of range has hundreds of digits, before the point or behind.
  const std::size_t first = word.find_first_not_of("+-0");
  return first != std::string_view::npos && word[first] == '.';
}

}  // namespace

std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+')) {
    word.remove_prefix(1);
    if (word.starts_with('-') || word.starts_with('+')) return std::nullopt;
  }
  const char* const end = word.data() + word.size();
  double value = 0;
  const auto [stop, status] = std::from_chars(word.data(), end, value);
  if (stop != end || word.empty()) return std::nullopt;
  if (status == std::errc()) return value;
  if (status == std::errc::result_out_of_range && underflows(word)) return 0.0;
  return std::nullopt;
}

std::optional<long long> parse_whole_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  long long value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, status] = std::from_chars(word.data(), end, value);
  if (status != std::errc() || stop != end) return std::nullopt;
  return value;
}

bool has_decimal_comma(std::string_view word) {
  const std::size_t comma = word.find(',');
  if (comma == std::string_view::npos || comma + 1 >= word.size()) return false;
  const std::string_view before = word.substr(0, comma);
  const std::string_view after = word.substr(comma + 1);
  const std::size_t sign = before.starts_with('-') || before.starts_with('+') ? 1 : 0;
  const std::size_t digits_after = std::min(after.find_first_not_of("0123456789"), after.size());
  const std::string_view rest = after.substr(digits_after);
  return digits_after > 0 && std::all_of(before.begin() + sign, before.end(), is_digit) &&
         (rest.empty() || rest[0] == 'e' || rest[0] == 'E');
}

std::string quotable(std::string_view text, std::size_t most) {
  std::string quoted(text.substr(0, most));
  for (char& c : quoted) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '?';
  }
  if (text.size() > most) quoted += "...";
  return quoted;
}

std::string why_no_number(std::string_view word) {
  const std::string quoted = quotable(word);
  if (word.empty()) return "nothing stands where a number should";
  if (has_decimal_comma(word)) return quoted + " has a decimal comma, write a point";
  if (word.ends_with(',') || word.ends_with(';')) {
    return quoted + " ends with a separator, separate by blanks";
  }
  if (word.find_first_of(",;") != std::string_view::npos) {
    return quoted + " holds separators, separate by blanks";
  }
  const std::size_t exponent = word.find_first_of("dD");
  if (exponent != std::string_view::npos) {
    std::string usual(word);
    usual[exponent] = 'e';
    if (parse_number(usual)) return quoted + " has an exponent after d, write e";
  }
  // A number with a unit behind it.
  double value = 0;
  const auto [stop, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (status == std::errc() && std::isalpha(static_cast<unsigned char>(*stop)) != 0) {
    return quoted + " has letters behind the number, write the number alone";
  }
  if (status == std::errc::result_out_of_range) return quoted + " is too large for a number";
  return quoted + " is no number";
}

}  // namespace sheen::core
