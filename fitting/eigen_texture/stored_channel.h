// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/eigen_texture/eigen_texture.h"
#include "fitting/eigen_texture/factors.h"

namespace sheen::fitting::eigen_texture {

/// In the precision of the model file: every basis in steps of its largest number's 127th, which
/// its coefficients take over.
Channel stored(const Factors& factors);

}  // namespace sheen::fitting::eigen_texture
