// SPDX-License-Identifier: MIT
#pragma once

#include "capture/dataset/dataset_formats.h"

#include <filesystem>

namespace sheen::capture {

/// Reads a bundle file of Bundler (v0.3; also those of VisualSFM, OpenMVG and COLMAP). The names of
/// the images stand in list.txt or NAME.list.txt beside it, one a line, and the size in the first
/// of them, in `images`. Cameras without a focal length were not posed and are left out. Throws
/// core::Error (bad_input).
Dataset read_bundle(const std::filesystem::path& path, const std::filesystem::path& images);

/// A file that ends in .out.
extern const DatasetFormat kBundlerFormat;

}  // namespace sheen::capture
