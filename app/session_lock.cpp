// SPDX-License-Identifier: MIT
#include "app/session_lock.h"

#include <algorithm>

namespace sheen::app {

SessionLock::SessionLock(const std::filesystem::path& session,
                         std::initializer_list<std::filesystem::path> outputs) {
  const auto lies_inside = [&](const std::filesystem::path& output) {
    std::error_code missing;  // what is not there is not in it
    return !output.empty() &&
           std::filesystem::equivalent(std::filesystem::absolute(output).parent_path(), session,
                                       missing);
  };
  if (std::ranges::any_of(outputs, lies_inside)) lock_.emplace(session);
}

}  // namespace sheen::app
