// SPDX-License-Identifier: MIT
#include "capture/calibration/colmap_lens.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace sheen::capture {
namespace {

constexpr auto kRational = core::LensKind::rational;
constexpr auto kFisheye = core::LensKind::fisheye;
constexpr std::array kColmapLenses{
    ColmapLens{0, "SIMPLE_PINHOLE", 1, 0, kRational},
    ColmapLens{1, "PINHOLE", 2, 0, kRational},
    ColmapLens{2, "SIMPLE_RADIAL", 1, 1, kRational},
    ColmapLens{3, "RADIAL", 1, 2, kRational},
    ColmapLens{4, "OPENCV", 2, 4, kRational},
    ColmapLens{5, "OPENCV_FISHEYE", 2, 4, kFisheye},
    ColmapLens{6, "FULL_OPENCV", 2, 8, kRational},
    ColmapLens{8, "SIMPLE_RADIAL_FISHEYE", 1, 1, kFisheye},
    ColmapLens{9, "RADIAL_FISHEYE", 1, 2, kFisheye},
};

}  // namespace

std::span<const ColmapLens> colmap_lenses() {
  return kColmapLenses;
}

const ColmapLens* find_colmap_lens(std::string_view name) {
  const auto found = std::find_if(kColmapLenses.begin(), kColmapLenses.end(),
                                  [name](const ColmapLens& lens) { return lens.name == name; });
  return found == kColmapLenses.end() ? nullptr : &*found;
}

LensRecord colmap_record(const ColmapLens& lens, int width_px, int height_px,
                         std::span<const double> values) {
  assert(values.size() == lens.parameter_count());
  LensRecord record;
  record.kind = lens.kind;
  record.width_px = width_px;
  record.height_px = height_px;
  record.focal_px = {values[0], values[lens.focals - 1]};
  record.principal_px = {values[lens.focals] - 0.5, values[lens.focals + 1] - 0.5};
  const auto distortion = values.subspan(lens.focals + 2);
  record.distortion.assign(distortion.begin(), distortion.end());
  // Lists of OpenCV's lenses have four entries at least.
  if (!record.distortion.empty() && record.distortion.size() < 4) record.distortion.resize(4);
  return record;
}

}  // namespace sheen::capture
