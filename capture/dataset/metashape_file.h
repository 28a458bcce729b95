// SPDX-License-Identifier: MIT
#pragma once

#include "capture/dataset/dataset_formats.h"

#include <filesystem>

namespace sheen::capture {

/// Reads the cameras of an Agisoft Metashape project, as its export of cameras (XML) has them: one
/// adjusted sensor, cameras that are enabled and aligned, the chunk's scale and place. Labels
/// without an ending are looked for in `images`. Throws core::Error (bad_input): several sensors or
/// chunks, places on the globe.
Dataset read_metashape(const std::filesystem::path& path, const std::filesystem::path& images);

/// A file that ends in .xml.
extern const DatasetFormat kMetashapeFormat;

}  // namespace sheen::capture
