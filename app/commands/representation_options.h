// SPDX-License-Identifier: MIT
#pragma once

#include "app/command_line/command_line.h"
#include "fitting/option_table.h"

#include <string>

namespace sheen::app {

/// Which representation is fitted, and how. The options are those of all descriptors
/// (fitting/descriptor.h); a word that only one representation knows implies it.
struct RepresentationChoice {
  std::string representation = "detail";  ///< name of a descriptor
  bool asked_by_name = false;             ///< else the default, or implied by other options
  fitting::OptionValues values{};         ///< only what was given, and fits the representation
};

/// Adds --representation and every representation's options. After parsing `choice` holds what
/// runs; options that contradict each other or what runs are refused.
void add_representation_options(Command command, RepresentationChoice& choice);

/// What the options come to. `given` are options by name; `representation` is empty where none was
/// asked for. Throws UsageError.
RepresentationChoice resolve_representation(std::string representation,
                                            fitting::OptionValues given);

}  // namespace sheen::app
