// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "exporters/viewer/page.h"

namespace sheen::exporters::viewer {

Page make_page(const fitting::Model& /*model*/, const Options& /*options*/) {
  throw core::Error(core::Error::Kind::run_failed, "this sheen", "was built without its web viewer",
                    "install esbuild and build with -DSHEEN_WEB=ON");
}

}  // namespace sheen::exporters::viewer
