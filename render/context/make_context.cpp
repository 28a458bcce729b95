// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "render/context/context.h"

namespace sheen::render {

std::unique_ptr<Context> make_context() {
  try {
    return make_egl_context(EglDevice::gpu);
  } catch (const core::Error&) {
    // No GPU is the normal case on servers.
    return make_osmesa_context();
  }
}

}  // namespace sheen::render
