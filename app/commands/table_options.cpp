// SPDX-License-Identifier: MIT
#include "app/commands/table_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace sheen::app {
namespace {

std::string help_of(const OwnedOption& known) {
  std::string text = fmt::format("With {}: {}", fmt::join(known.owners, ", "), known.option.help);
  if (const std::string shown = known.option.get(); !shown.empty() && !known.option.is_flag()) {
    text += " (default " + shown + ")";
  }
  return text;
}

}  // namespace

void add_owner(std::string_view owner, fitting::FitOptions& options,
               std::vector<OwnedOption>& known) {
  for (fitting::FitOption& option : options.table()) {
    const auto same = std::ranges::find_if(
        known, [&](const OwnedOption& k) { return k.option.name == option.name; });
    if (same != known.end()) {
      same->owners.emplace_back(owner);
      continue;
    }
    // The help needs the default's text, not the options it stands in.
    const std::string default_text = option.get();
    option.get = [default_text] { return default_text; };
    option.set = {};
    known.push_back({std::move(option), {std::string(owner)}});
  }
}

void add_table_options(
    Command command, const std::vector<OwnedOption>& known,
    const std::function<void(const std::string& name, const std::string& text)>& take) {
  for (const OwnedOption& one : known) {
    const std::string name = one.option.name;
    if (one.option.is_flag()) {
      command.switch_on(
          "--" + name, [take, name] { take(name, "true"); }, help_of(one));
    } else {
      command
          .option(
              "--" + name, [take, name](const std::string& text) { take(name, text); },
              help_of(one))
          .type(one.option.type);
    }
  }
}

}  // namespace sheen::app
