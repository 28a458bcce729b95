// SPDX-License-Identifier: MIT
#pragma once

#include "capture/dataset/dataset_formats.h"

#include <filesystem>

namespace sheen::capture {

enum class ColmapForm { text, binary };

/// Reads cameras and images of a COLMAP model, binary where the folder has both as COLMAP itself
/// does. Camera models: SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV,
/// OPENCV_FISHEYE, SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE. Throws core::Error (bad_input) with one
/// line: other models by name, files cut short, counts that their file cannot hold.
Dataset read_colmap_model(const std::filesystem::path& folder);

/// Writes cameras, images and points3D (.txt or .bin) into an existing `folder`; points have no
/// tracks. `read_colmap_model` gives cameras and poses back to rounding. A camera gets the smallest
/// of PINHOLE, OPENCV and FULL_OPENCV that holds its lens, or OPENCV_FISHEYE.
void write_colmap_model(const std::filesystem::path& folder, const Dataset& dataset,
                        ColmapForm form);

/// COLMAP's folders: images/, masks/ and the model in sparse/0. Read from there, from the folder
/// itself, from sparse or colmap/sparse/0, in either form.
extern const DatasetFormat kColmapFormat, kColmapTextFormat;

}  // namespace sheen::capture
