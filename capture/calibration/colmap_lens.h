// SPDX-License-Identifier: MIT
#pragma once

#include "capture/calibration/lens_record.h"

#include <cstddef>
#include <span>
#include <string_view>

namespace sheen::capture {

/// A camera model of COLMAP (src/colmap/sensor/models.h there) that is a lens of ours: where its
/// parameters go. They are one or two focal lengths, the principal point, then the distortion.
struct ColmapLens {
  int id;  ///< in binary models
  std::string_view name;
  std::size_t focals;      ///< 1: fx = fy
  std::size_t distortion;  ///< parameters behind the principal point, in LensRecord's order
  core::LensKind kind;

  [[nodiscard]] std::size_t parameter_count() const { return focals + 2 + distortion; }
};

/// All that are known, by id: SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV,
/// OPENCV_FISHEYE, FULL_OPENCV, SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE.
std::span<const ColmapLens> colmap_lenses();

/// Null where it is not among them.
const ColmapLens* find_colmap_lens(std::string_view name);

/// A camera of `width` x `height` pixels with as many `values` as the model has parameters. COLMAP
/// counts pixels from the corner of the first one: half a pixel is taken off.
LensRecord colmap_record(const ColmapLens& lens, int width_px, int height_px,
                         std::span<const double> values);

}  // namespace sheen::capture
