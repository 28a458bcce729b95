// SPDX-License-Identifier: MIT
#define SHEEN_LANES portable
#include "core/visibility/raster_loops.h"

namespace sheen::core {

RasterKernels portable_raster_kernels();
RasterKernels portable_raster_kernels() {
  return {"portable", portable::draw};
}

}  // namespace sheen::core
