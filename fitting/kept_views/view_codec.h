// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/kept_views/kept_view.h"
#include "fitting/model_file/model_part.h"

#include <span>
#include <vector>

namespace sheen::fitting {

/// Adds photographs to a part of a model file. Parameters: cameras, one object per camera
/// {size, focal, principal, distortion, lens}; views, their number; cacheMb. Arrays, left out where
/// there is no view: poses, doubles [view][3][4], camera_from_object row by row; crops, unsigned
/// 32-bit [view][camera, left, top, width, height, bytes]; images, the JPEGs one behind the other.
void encode_views(std::span<const KeptView> views, int cache_mb, ModelPart& part);

struct DecodedViews {
  std::vector<KeptView> views;
  int cache_mb;
};
/// Throws ModelFault for anything that `encode_views` does not write. JPEGs are only looked at for
/// their size.
DecodedViews decode_views(const ModelPart& part);

}  // namespace sheen::fitting
