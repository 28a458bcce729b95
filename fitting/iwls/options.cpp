// SPDX-License-Identifier: MIT
#include "fitting/iwls/options.h"

#include <array>
#include <cstddef>
#include <stdexcept>

namespace sheen::fitting::iwls {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, 3> kConstructionNames{"quadtree", "adaptive", "batch"};
constexpr std::array<std::string_view, 4> kLayoutNames{"grid", "jittered-grid", "disk",
                                                       "jittered-disk"};

template <typename Enum, std::size_t kCount>
std::optional<Enum> find_name(const std::array<std::string_view, kCount>& names,
                              std::string_view name) {
  for (std::size_t i = 0; i < kCount; ++i) {
    if (names[i] == name) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace

std::string_view name_of(Construction construction) {
  return kConstructionNames[static_cast<std::size_t>(construction)];
}

std::string_view name_of(Layout layout) {
  return kLayoutNames[static_cast<std::size_t>(layout)];
}

std::optional<Construction> construction_named(std::string_view name) {
  return find_name<Construction>(kConstructionNames, name);
}

std::optional<Layout> layout_named(std::string_view name) {
  return find_name<Layout>(kLayoutNames, name);
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

}  // namespace sheen::fitting::iwls
