// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string_view>

namespace sheen::reconstruction {

/// Hears of long work, on the thread that called; what it throws ends the work.
using WorkProgress = std::function<void(std::string_view step, int done, int total)>;

}  // namespace sheen::reconstruction
