// SPDX-License-Identifier: MIT
#include "app/batch/batch_page.h"

#include "app/batch/page_text.h"
#include "core/text/script_text.h"
#include "evaluation/comparison/page_text.h"

#include <string_view>

namespace sheen::app {
namespace {

void fill_in(std::string& page, std::string_view mark, std::string_view text) {
  const auto place = page.find(mark);
  if (place != std::string::npos) page.replace(place, mark.size(), text);
}

}  // namespace

std::string batch_page(const nlohmann::ordered_json& summary) {
  std::string page(batch_page_text("batch.html"));
  // The data last: names of sessions must not be taken for marks.
  fill_in(page, "/*{{style}}*/", evaluation::page_text("page.css"));
  fill_in(page, "/*{{batch-style}}*/", batch_page_text("batch.css"));
  fill_in(page, "/*{{script}}*/", batch_page_text("batch.js"));
  fill_in(page, "{{data}}",
          core::in_script(
              summary.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)));
  return page;
}

}  // namespace sheen::app
