// SPDX-License-Identifier: MIT
#include "evaluation/comparison/comparison_files.h"

#include "core/diagnostics/error.h"
#include "core/files/write_file.h"
#include "core/text/script_text.h"
#include "evaluation/comparison/page_text.h"
#include "evaluation/comparison/run_program.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

namespace sheen::evaluation {
namespace {

namespace fs = std::filesystem;

// Debian's: other Pythons on the PATH may lack matplotlib.
constexpr const char* kPython = "/usr/bin/python3";
constexpr const char* kChartLibrary = "/usr/share/javascript/chart.js/chart.min.js";

std::optional<std::string> read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

void replace_once(std::string& text, const std::string& mark, std::string_view by) {
  const auto place = text.find(mark);
  if (place != std::string::npos) text.replace(place, mark.size(), by);
}

void write_page(const fs::path& staging, const nlohmann::ordered_json& document,
                std::vector<std::string>& notes) {
  const auto library = read_text(kChartLibrary);
  if (!library) {
    notes.emplace_back("no compare.html: Chart.js is missing; install libjs-chart.js");
    return;
  }
  std::string page(page_text("page.html"));
  // The data last: names of sessions must not be taken for marks.
  replace_once(page, "/*{{style}}*/", page_text("page.css"));
  replace_once(page, "/*{{library}}*/", *library);
  replace_once(page, "/*{{script}}*/", page_text("page.js"));
  replace_once(page, "{{data}}",
               core::in_script(document.dump(-1, ' ', false,
                                             nlohmann::ordered_json::error_handler_t::replace)));
  core::write_file(staging / "compare.html", page);
}

void draw_charts(const fs::path& staging, std::vector<std::string>& notes) {
  const auto messages = staging / "messages.txt";
  const auto status = run_program({kPython, "-I", "-c", std::string(page_text("charts.py")),
                                   (staging / "compare.csv").string(), staging.string()},
                                  messages);
  const std::string said = read_text(messages).value_or("");
  fs::remove(messages);
  if (!status) {
    notes.emplace_back(
        "no PNG and SVG charts: /usr/bin/python3 is missing; install "
        "python3-matplotlib");
  } else if (*status == 3) {
    notes.emplace_back("no PNG and SVG charts: matplotlib is missing; install python3-matplotlib");
  } else if (*status != 0) {
    const auto end = said.find_last_not_of('\n');
    const auto begin = said.find_last_of('\n', end);
    const std::string last_line = said.substr(begin == std::string::npos ? 0 : begin + 1);
    notes.push_back("no PNG and SVG charts: " + last_line.substr(0, last_line.find('\n')));
  }
}

void move_into_place(const fs::path& staging, const fs::path& folder, ComparisonFiles& files) {
  std::vector<fs::path> staged;
  for (const auto& entry : fs::directory_iterator(staging)) staged.push_back(entry.path());
  std::sort(staged.begin(), staged.end());
  for (const fs::path& path : staged) {
    const fs::path final_path = folder / path.filename();
    std::error_code failure;
    fs::rename(path, final_path, failure);
    if (failure) {
      throw core::Error(core::Error::Kind::run_failed, final_path,
                        "cannot be moved into place (" + failure.message() + ")",
                        "check free space and permissions of its folder");
    }
    files.written.push_back(final_path);
  }
}

}  // namespace

ComparisonFiles write_comparison(const fs::path& folder, const fs::path& staging,
                                 const std::string& csv, const nlohmann::ordered_json& document) {
  ComparisonFiles files;
  core::write_file(staging / "compare.csv", csv);
  write_page(staging, document, files.notes);
  draw_charts(staging, files.notes);
  move_into_place(staging, folder, files);
  return files;
}

}  // namespace sheen::evaluation
