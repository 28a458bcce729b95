// SPDX-License-Identifier: MIT
#pragma once

#include "app/command_line/command_line.h"
#include "fitting/option_table.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::app {

/// A setting and all that have it (representations, formats), in the order they were added.
struct OwnedOption {
  fitting::FitOption option;
  std::vector<std::string> owners;
};

/// Adds the settings of one more owner; those of a known name get it as another owner. Only the
/// text of their defaults is kept of `options`.
void add_owner(std::string_view owner, fitting::FitOptions& options,
               std::vector<OwnedOption>& known);

/// One option of the command for each; `take` hears the name and text of what is given.
void add_table_options(
    Command command, const std::vector<OwnedOption>& known,
    const std::function<void(const std::string& name, const std::string& text)>& take);

}  // namespace sheen::app
