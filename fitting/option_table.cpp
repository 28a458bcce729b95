// SPDX-License-Identifier: MIT
#include "fitting/option_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace sheen::fitting {
namespace {

/// As short as it can be: 0.02 and not 0.020000.
template <typename Number>
std::string text_of(Number value) {
  char digits[32];
  const auto end = std::to_chars(std::begin(digits), std::end(digits), value).ptr;
  return {digits, end};
}

/// `text` as a number in [least, most].
template <typename Number>
Number parsed(const std::string& name, const std::string& text, Number least, Number most) {
  Number value{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = fault == std::errc() && end == text.data() + text.size();
  if (!is_number || !(value >= least && value <= most)) {
    refuse_value(name, text, text_of(least) + " to " + text_of(most));
  }
  return value;
}

}  // namespace

void refuse_value(const std::string& name, const std::string& text, const std::string& allowed) {
  throw std::invalid_argument("--" + name + " is \"" + text + "\", allowed: " + allowed);
}

void require_value(bool holds, const std::string& name, double value, const std::string& allowed) {
  if (!holds) refuse_value(name, text_of(value), allowed);
}

FitOption number_option(std::string name, double& value, double least, double most,
                        std::string help) {
  FitOption option{name, std::move(help), "NUMBER", {}, [&value] { return text_of(value); }};
  option.set = [name = std::move(name), least, most, &value](const std::string& text) {
    value = parsed(name, text, least, most);
  };
  return option;
}

FitOption number_option(std::string name, int& value, int least, int most, std::string help) {
  FitOption option{name, std::move(help), "NUMBER", {}, [&value] { return text_of(value); }};
  option.set = [name = std::move(name), least, most, &value](const std::string& text) {
    value = parsed(name, text, least, most);
  };
  return option;
}

FitOption number_option(std::string name, std::optional<float>& value, double least, double most,
                        std::string help) {
  FitOption option{name, std::move(help), "NUMBER", {}, {}};
  option.set = [name = std::move(name), least, most, &value](const std::string& text) {
    value = static_cast<float>(parsed(name, text, least, most));
  };
  option.get = [&value] { return value ? text_of(*value) : std::string(); };
  return option;
}

FitOption flag_option(std::string name, bool& value, std::string help) {
  FitOption option{name, std::move(help), {}, {}, [&value] { return value ? "true" : "false"; }};
  option.set = [name = std::move(name), &value](const std::string& text) {
    if (text != "true" && text != "false") refuse_value(name, text, "true, false");
    value = text == "true";
  };
  return option;
}

void apply(const OptionValues& values, std::string_view representation, const OptionTable& table) {
  for (const auto& [name, text] : values) {
    const auto option = std::ranges::find(table, name, &FitOption::name);
    if (option == table.end()) {
      throw std::invalid_argument("--" + name + " is no option of representation " +
                                  std::string(representation));
    }
    option->set(text);
  }
}

}  // namespace sheen::fitting
