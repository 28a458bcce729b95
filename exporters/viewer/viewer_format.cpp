// SPDX-License-Identifier: MIT
#include "exporters/viewer/viewer_format.h"

#include "core/diagnostics/error.h"
#include "exporters/viewer/options.h"

namespace sheen::exporters::viewer {
namespace {

constexpr std::string_view kEndings[] = {".html"};

Written write(const fitting::Model& /*model*/, const std::filesystem::path& path,
              const fitting::FitOptions& /*options*/) {
  throw core::Error(core::Error::Kind::run_failed, path,
                    "this sheen was built without its web viewer",
                    "build it with node and npm installed and -DSHEEN_WEB=ON");
}

}  // namespace

constinit const Format kFormat{.name = "web viewer",
                               .endings = kEndings,
                               .sentence = "one page that shows the light field in any browser",
                               .default_options = fitting::new_options<Options>,
                               .write = write};

}  // namespace sheen::exporters::viewer
