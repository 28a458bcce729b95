// SPDX-License-Identifier: MIT
#include "evaluation/report/chart_script.h"

#include "evaluation/report/run_program.h"

#include <fstream>
#include <iterator>

namespace sheen::evaluation {
namespace {

// Debian's: other Pythons on the PATH may lack matplotlib.
constexpr const char* kPython = "/usr/bin/python3";

std::string last_line_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string said(std::istreambuf_iterator<char>(file), {});
  const auto end = said.find_last_not_of('\n');
  const auto begin = said.find_last_of('\n', end);
  const std::string line = said.substr(begin == std::string::npos ? 0 : begin + 1);
  return line.substr(0, line.find('\n'));
}

}  // namespace

std::optional<std::string> draw_charts(const std::string& script, const std::filesystem::path& csv,
                                       const std::filesystem::path& folder) {
  const auto messages = folder / "messages.txt";
  const auto status =
      run_program({kPython, "-I", "-c", script, csv.string(), folder.string()}, messages);
  const std::string said = last_line_of(messages);
  std::filesystem::remove(messages);
  if (!status) {
    return "no PNG and SVG charts: /usr/bin/python3 is missing; install python3-matplotlib";
  }
  if (*status == 0) return std::nullopt;
  if (*status == 3) {
    return "no PNG and SVG charts: matplotlib is missing; install python3-matplotlib";
  }
  return "no PNG and SVG charts: " + said;
}

}  // namespace sheen::evaluation
