// SPDX-License-Identifier: MIT
#include "app/commands/representation_options.h"

#include "app/commands/table_options.h"
#include "fitting/descriptor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <set>
#include <vector>

namespace sheen::app {
namespace {

/// The settings of all representations, in the order of the registry.
std::vector<OwnedOption> known_options() {
  std::vector<OwnedOption> known;
  for (const fitting::Descriptor* descriptor : fitting::representations()) {
    add_owner(descriptor->name, *descriptor->default_options(), known);
  }
  return known;
}

const OwnedOption& known_option(const std::vector<OwnedOption>& known, const std::string& name) {
  return *std::ranges::find_if(known, [&](const OwnedOption& k) { return k.option.name == name; });
}

/// --fitter once named the sparse representation, too.
void take_fitter_as_representation(std::string& representation, fitting::OptionValues& given) {
  const auto fitter = given.find("fitter");
  if (fitter == given.end() || fitter->second != "sparse") return;
  if (!representation.empty() && representation != "sparse") {
    throw UsageError("--fitter sparse contradicts --representation " + representation);
  }
  representation = "sparse";
  given.erase(fitter);
}

/// The first representation that has all the options; throws where none has.
std::string implied_representation(const fitting::OptionValues& given,
                                   const std::vector<OwnedOption>& known) {
  for (const fitting::Descriptor* descriptor : fitting::representations()) {
    const bool has_all = std::ranges::all_of(given, [&](const auto& option) {
      const auto& owners = known_option(known, option.first).owners;
      return std::ranges::find(owners, descriptor->name) != owners.end();
    });
    if (has_all) return std::string(descriptor->name);
  }
  std::vector<std::string> claims;
  for (const auto& [name, text] : given) {
    claims.push_back(
        fmt::format("--{} is of {}", name, fmt::join(known_option(known, name).owners, ", ")));
  }
  throw UsageError(fmt::format("these options exclude each other: {}", fmt::join(claims, "; ")));
}

void refuse_foreign_options(const std::string& representation, const fitting::OptionValues& given,
                            const std::vector<OwnedOption>& known) {
  for (const auto& [name, text] : given) {
    const auto& owners = known_option(known, name).owners;
    if (std::ranges::find(owners, representation) != owners.end()) continue;
    throw UsageError(fmt::format("--{} does not apply to --representation {}, it is of {}", name,
                                 representation, fmt::join(owners, ", ")));
  }
}

}  // namespace

RepresentationChoice resolve_representation(std::string representation,
                                            fitting::OptionValues given) {
  const std::vector<OwnedOption> known = known_options();
  take_fitter_as_representation(representation, given);
  const bool asked_by_name = !representation.empty();
  if (representation.empty()) representation = implied_representation(given, known);
  refuse_foreign_options(representation, given, known);
  // Values that are not allowed are refused now, before the long work.
  static_cast<void>(fitting::options_from(fitting::representation_named(representation), given));
  return {std::move(representation), asked_by_name, std::move(given)};
}

void add_representation_options(Command command, RepresentationChoice& choice) {
  struct Given {
    std::string representation;
    fitting::OptionValues values;
  };
  const auto given = std::make_shared<Given>();
  std::vector<std::string> names;
  std::string sentences = "How the object is modelled; ";
  for (const fitting::Descriptor* descriptor : fitting::representations()) {
    names.emplace_back(descriptor->name);
    sentences += fmt::format("{}{}: {}", names.size() > 1 ? "; " : "", descriptor->name,
                             descriptor->sentence);
  }
  command
      .option("--representation", given->representation,
              sentences + " (default " + choice.representation +
                  ", or the one that the options below belong to)")
      .one_of(names);
  add_table_options(
      command, known_options(),
      [given](const std::string& name, const std::string& text) { given->values[name] = text; });
  command.after_parsing(
      [given, &choice] { choice = resolve_representation(given->representation, given->values); });
}

}  // namespace sheen::app
