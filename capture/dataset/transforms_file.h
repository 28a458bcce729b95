// SPDX-License-Identifier: MIT
#pragma once

#include "capture/dataset/dataset_formats.h"

#include <filesystem>

namespace sheen::capture {

/// Reads a transforms.json of nerfstudio or instant-ngp. Intrinsics of a frame win over those of
/// the file; `camera_model` PINHOLE, SIMPLE_PINHOLE, OPENCV and OPENCV_FISHEYE, `is_fisheye`,
/// `camera_angle_x` in place of `fl_x`, `distortion_params`. `applied_transform` and
/// `applied_scale` are left applied. Throws core::Error (bad_input) with one line that names the
/// frame and key: other camera models, poses that are not rigid, images outside the folder.
Dataset read_transforms(const std::filesystem::path& path);

/// Writes `path`, a transforms.json that `read_transforms` reads back exactly; points by the name
/// of the file that has them, masks where all frames have one, lists of held-out frames where some
/// are. Lenses that the form cannot hold (k4 to k6 of a rational one) throw core::Error
/// (bad_input).
void write_transforms(const std::filesystem::path& path, const Dataset& dataset);

/// A transforms.json beside its images.
extern const DatasetFormat kNerfstudioFormat;

}  // namespace sheen::capture
