// SPDX-License-Identifier: MIT
#pragma once

#include "app/command_line/command_line.h"
#include "app/progress.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace sheen::app {

/// What every subcommand is told and how it answers: results on stdout, the rest on stderr.
struct CommandContext {
  /// Lines told so far.
  struct Notes {
    std::mutex mutex;
    std::vector<std::string> lines;
  };
  std::shared_ptr<Notes> notes = std::make_shared<Notes>();
  int threads = 1;
  bool quiet = false;
  bool json = false;
  std::filesystem::path report_path;  ///< --report; empty: none

  /// Bar on a terminal, plain lines otherwise, nothing with --quiet.
  [[nodiscard]] Progress progress(std::string what, int total) const {
    return {std::move(what), total, quiet};
  }

  /// One line on stderr, unless --quiet; it also stands in the report, so that doubts do not get
  /// lost. What was said already, by an earlier step over the same frames, is not said again. From
  /// any thread.
  void note(const std::string& line) const;

  /// Throws core::Error (bad_input) when the report or one of `outputs` (empty paths: not asked
  /// for) cannot be written: before the long work, not after it.
  void check_outputs(const std::vector<std::filesystem::path>& outputs) const;

  /// Ends a command: `document` to --report and, with --json, to stdout; else `text` to stdout.
  /// Notes go with the document, and with the text where --quiet kept them from stderr.
  void publish(const nlohmann::ordered_json& document, const std::string& text) const;
};

/// --threads, --quiet, --json, --report: the same words for every subcommand.
void add_common_options(Command command, CommandContext& context);

}  // namespace sheen::app
