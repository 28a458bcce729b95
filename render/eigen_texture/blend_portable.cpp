// SPDX-License-Identifier: MIT
#include "render/eigen_texture/blend_loops.h"

namespace sheen::render::eigen_texture {

BlendKernel portable_kernel();
BlendKernel portable_kernel() {
  return {"portable", BasisLayout::planes, blend_plainly};
}

}  // namespace sheen::render::eigen_texture
