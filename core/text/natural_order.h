// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace sheen::core {

/// Whether a name comes before another one where its numbers count as numbers: IMG_9 before IMG_10.
/// A strict order; names that differ in leading zeros only are ordered by their letters.
bool comes_before(std::string_view a, std::string_view b);

}  // namespace sheen::core
