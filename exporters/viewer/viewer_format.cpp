// SPDX-License-Identifier: MIT
#include "exporters/viewer/viewer_format.h"

#include "core/files/write_file.h"
#include "exporters/viewer/page.h"

#include <utility>

namespace sheen::exporters::viewer {
namespace {

constexpr std::string_view kEndings[] = {".html"};

Written write(const fitting::Model& model, const std::filesystem::path& path,
              const fitting::FitOptions& given) {
  Options options = fitting::options_as<Options>(given);
  if (options.title.empty()) options.title = path.stem().string();
  Page page = make_page(model, options);
  core::write_file(path, page.html);
  Written written;
  written.files = {path};
  written.as_read = std::move(page.model);
  if (model.seen.empty()) {
    written.remarks.emplace_back(
        "the model does not say from where it was looked at: the page cannot tell where nobody "
        "looked; fit it again with this version");
  }
  return written;
}

}  // namespace

constinit const Format kFormat{.name = "web viewer",
                               .endings = kEndings,
                               .sentence = "one page that shows the light field in any browser",
                               .default_options = fitting::new_options<Options>,
                               .write = write};

}  // namespace sheen::exporters::viewer
