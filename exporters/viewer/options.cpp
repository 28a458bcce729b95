// SPDX-License-Identifier: MIT
#include "exporters/viewer/options.h"

#include "exporters/upright.h"

#include <string>

namespace sheen::exporters::viewer {
namespace {

bool is_colour(const std::string& text) {
  return text.size() == 7 && text.front() == '#' &&
         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
}

}  // namespace

void Options::check() const {
  check_up(up);
  if (background != "dark" && background != "light" && !is_colour(background)) {
    fitting::refuse_value("background", background, "dark, light or a colour such as #204060");
  }
}

fitting::OptionTable option_table(Options& options) {
  const auto text = [](const char* name, const char* type, const char* help, auto& value) {
    return fitting::FitOption{name, help, type,
                              [&value](const std::string& given) { value = given; },
                              [&value] { return std::string(value); }};
  };
  return {
      text("title", "TEXT", "Title of the page (default: the file's name)", options.title),
      text("background", "dark|light|#rrggbb", "Background that the page opens with",
           options.background),
      up_option(options.up),
      text("poster", "FILE.png",
           "Picture that is shown until the model is there, and where it cannot be drawn; drawn "
           "where there is no such file",
           options.poster)};
}

}  // namespace sheen::exporters::viewer
