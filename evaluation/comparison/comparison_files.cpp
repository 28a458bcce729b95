// SPDX-License-Identifier: MIT
#include "evaluation/comparison/comparison_files.h"

#include "core/files/staged_output.h"
#include "core/files/write_file.h"
#include "core/text/script_text.h"
#include "evaluation/comparison/page_text.h"
#include "evaluation/report/chart_script.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

namespace sheen::evaluation {
namespace {

namespace fs = std::filesystem;

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

void move_into_place(const fs::path& staging, const fs::path& folder, ComparisonFiles& files) {
  std::vector<fs::path> staged;
  for (const auto& entry : fs::directory_iterator(staging)) staged.push_back(entry.path());
  std::sort(staged.begin(), staged.end());
  for (const fs::path& path : staged) {
    const fs::path final_path = folder / path.filename();
    core::StagedOutput output(final_path);  // charts are another program's, so not flushed yet
    fs::rename(path, output.path());
    output.commit();
    files.written.push_back(final_path);
  }
}

}  // namespace

ComparisonFiles write_comparison(const fs::path& folder, const fs::path& staging,
                                 const std::string& csv, const nlohmann::ordered_json& document) {
  ComparisonFiles files;
  core::write_file(staging / "compare.csv", csv);
  write_page(staging, document, files.notes);
  if (auto note =
          draw_charts(std::string(page_text("charts.py")), staging / "compare.csv", staging)) {
    files.notes.push_back(*std::move(note));
  }
  move_into_place(staging, folder, files);
  return files;
}

}  // namespace sheen::evaluation
