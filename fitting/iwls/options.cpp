// SPDX-License-Identifier: MIT
#include "fitting/iwls/options.h"

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace sheen::fitting::iwls {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, 3> kConstructionNames{"quadtree", "adaptive", "batch"};
constexpr std::array<std::string_view, 4> kLayoutNames{"grid", "jittered-grid", "disk",
                                                       "jittered-disk"};

/// Every name with its enumerator.
template <typename Enum, std::size_t kCount>
std::vector<std::pair<std::string, Enum>> words(const std::array<std::string_view, kCount>& names) {
  std::vector<std::pair<std::string, Enum>> all;
  for (const std::string_view name : names) all.emplace_back(name, static_cast<Enum>(all.size()));
  return all;
}

}  // namespace

std::string_view name_of(Construction construction) {
  return kConstructionNames[static_cast<std::size_t>(construction)];
}

std::string_view name_of(Layout layout) {
  return kLayoutNames[static_cast<std::size_t>(layout)];
}

std::optional<Layout> layout_named(std::string_view name) {
  for (const auto& [word, layout] : words<Layout>(kLayoutNames)) {
    if (word == name) return layout;
  }
  return std::nullopt;
}

void Options::check() const {
  if (centers != 16 && centers != 64) {
    throw std::invalid_argument("centers is " + std::to_string(centers) +
                                ", allowed are 16 and 64");
  }
  if (terms != 0 && terms != 1 && terms != 3 && terms != 6) {
    throw std::invalid_argument("terms is " + std::to_string(terms) +
                                ", allowed are 1, 3, 6 and 0 (auto)");
  }
  if (faithful && (terms == 1 || terms == 6)) {
    throw std::invalid_argument("terms is " + std::to_string(terms) +
                                ", but faithful fits have 3 terms");
  }
}

OptionTable option_table(Options& options) {
  return {choice_option("fitter", options.construction, words<Construction>(kConstructionNames),
                        "The paper's construction of the centres"),
          choice_option("layout", options.layout, words<Layout>(kLayoutNames),
                        "Where the centres lie on the disc of directions"),
          choice_option("centers", options.centers, {{"16", 16}, {"64", 64}},
                        "How many centres per patch"),
          choice_option("terms", options.terms, {{"1", 1}, {"3", 3}, {"6", 6}, {"auto", 0}},
                        "Polynomial terms of each centre"),
          flag_option("faithful", options.faithful,
                      "Exactly the paper's rules: centres of 3 terms, no ridge")};
}

}  // namespace sheen::fitting::iwls
