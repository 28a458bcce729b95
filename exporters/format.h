// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/model_file/model_file.h"
#include "fitting/option_table.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::exporters {

/// What a written file holds.
struct Written {
  std::vector<std::filesystem::path> files;
  /// The model as whoever reads the file sees it, where it differs from what was given and is still
  /// a light field over the same mesh: what the conversion costs is measured on it.
  std::optional<fitting::Model> as_read;
  /// What the user should know, a sentence each ("directions nobody looked from are not marked").
  std::vector<std::string> remarks;
};

/// One format that models are exported to: all that the program knows of it. The command line, its
/// help and the choice by ending follow from the list in registry.cpp.
struct Format {
  std::string_view name;                      ///< in reports: "web viewer"
  std::span<const std::string_view> endings;  ///< of file names, lower case: ".html"
  std::string_view sentence;                  ///< for the help: what it is, in a few words

  /// Its settings at their defaults (fitting/option_table.h).
  std::unique_ptr<fitting::FitOptions> (*default_options)();

  /// Writes beside the final name and moves into place. `options` come from `default_options` and
  /// are checked. Throws core::Error: bad_input for models that the format cannot hold.
  Written (*write)(const fitting::Model& model, const std::filesystem::path& path,
                   const fitting::FitOptions& options);
};

/// In the order in which users should see them.
std::span<const Format* const> formats();

/// The format whose ending is the longest that the file's name has (".splat.ply" before ".ply"),
/// whatever the case. Throws core::Error (bad_input) that lists the known ones.
const Format& format_of(const std::filesystem::path& path);

}  // namespace sheen::exporters
