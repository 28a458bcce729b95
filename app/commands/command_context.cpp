// SPDX-License-Identifier: MIT
#include "app/commands/command_context.h"

#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"
#include "core/files/write_file.h"

#include <algorithm>
#include <cstdio>
#include <thread>

namespace sheen::app {
void CommandContext::note(const std::string& line) const {
  const std::scoped_lock lock(notes->mutex);
  if (std::ranges::find(notes->lines, line) != notes->lines.end()) return;
  notes->lines.push_back(line);
  if (!quiet) std::fprintf(stderr, "%s\n", line.c_str());
}

void CommandContext::check_outputs(const std::vector<std::filesystem::path>& outputs) const {
  if (!report_path.empty()) core::check_writable(report_path);
  for (const auto& path : outputs) {
    if (!path.empty()) core::check_writable(path);
  }
}

void CommandContext::publish(const nlohmann::ordered_json& document,
                             const std::string& text) const {
  const std::scoped_lock lock(notes->mutex);
  nlohmann::ordered_json complete = document;
  if (complete.is_object() && !notes->lines.empty()) complete["notes"] = notes->lines;
  // Paths may hold bytes that are no UTF-8; they must not cost the whole report.
  const std::string json_text =
      complete.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  if (!report_path.empty()) core::write_file(report_path, json_text + "\n");
  std::string answer = json ? json_text : text;
  if (!json && quiet) {
    for (const std::string& line : notes->lines) answer += line + "\n";
  }
  std::fputs(answer.c_str(), stdout);
  if (!answer.empty() && answer.back() != '\n') std::fputc('\n', stdout);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw core::Error(core::Error::Kind::run_failed, "standard output", "could not be written",
                      "check free space or who reads it");
  }
}

void add_common_options(Command command, CommandContext& context) {
  context.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  command
      .option("--threads", context.threads,
              "Worker threads; results do not depend on it (default: all cores)")
      .range(1, 256)
      .type("N");
  command.flag("--quiet", context.quiet, "No progress and no notes on stderr");
  command.flag("--json", context.json, "Print one JSON document instead of text");
  command.option("--report", context.report_path, "Also write the JSON document to this file")
      .type("FILE");
}

}  // namespace sheen::app
