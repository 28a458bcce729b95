// SPDX-License-Identifier: MIT
#pragma once

#include "exporters/viewer/options.h"
#include "fitting/model_file/model_file.h"

#include <string>

namespace sheen::exporters::viewer {

/// The page, complete, and the model that it shows.
struct Page {
  std::string html;
  fitting::Model model;
};

/// Throws core::Error (bad_input) for models that the viewer cannot show, and for a poster that is
/// no PNG.
Page make_page(const fitting::Model& model, const Options& options);

}  // namespace sheen::exporters::viewer
