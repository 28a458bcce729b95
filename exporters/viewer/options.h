// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/option_table.h"

#include <filesystem>
#include <string>

namespace sheen::exporters::viewer {

struct Options {
  std::string title;                ///< of the page; empty: the file's name
  std::string background = "dark";  ///< dark, light or #rrggbb
  std::string up = "z";             ///< upright axis of the object: x, y, z, -x, -y or -z
  std::filesystem::path poster;     ///< picture shown until the model is there; empty: none

  /// Throws std::invalid_argument.
  void check() const;
};

fitting::OptionTable option_table(Options& options);

}  // namespace sheen::exporters::viewer
