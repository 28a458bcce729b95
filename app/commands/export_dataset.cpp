// SPDX-License-Identifier: MIT
#include "app/commands/export_dataset.h"

#include "app/terminal_sink.h"
#include "capture/dataset/dataset_formats.h"
#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

const capture::DatasetFormat& format_named(const std::string& name, const fs::path& session) {
  for (const capture::DatasetFormat* format : capture::dataset_formats()) {
    if (format->name == name) return *format;
  }
  throw core::bad_input(
      session, "is a session, which becomes a data set",
      fmt::format("say --format {}", fmt::join(written_dataset_formats(), " or ")));
}

}  // namespace

std::vector<std::string> written_dataset_formats() {
  std::vector<std::string> names;
  for (const capture::DatasetFormat* format : capture::dataset_formats()) {
    if (format->write != nullptr) names.emplace_back(format->name);
  }
  return names;
}

std::string dataset_formats_help() {
  std::string text = "A session becomes a folder of posed images, by --format:\n";
  for (const capture::DatasetFormat* format : capture::dataset_formats()) {
    if (format->write != nullptr) {
      text += fmt::format("  {:<12}{}\n", format->name, format->sentence);
    }
  }
  return text;
}

void export_dataset(const fs::path& source, const fs::path& folder, const DatasetExport& options,
                    const pipeline::FrameChoice& frames, const CommandContext& context) {
  const capture::DatasetFormat& format = format_named(options.format, source);
  std::error_code no_throw;
  if (fs::exists(folder, no_throw)) {
    throw core::bad_input(folder, "exists already", "choose another name for the data set");
  }
  context.check_outputs({folder});
  const capture::Session session = capture::open_session(source);
  for (const std::string& warning : session.warnings) context.note(warning);

  core::StagedOutput staged(folder);
  fs::create_directories(staged.path());
  TerminalSink sink(context);
  const capture::Dataset dataset = pipeline::write_session_dataset(
      session, {.frames = frames, .undistort = options.undistort, .threads = context.threads},
      staged.path(), sink);
  format.write(staged.path(), dataset);
  staged.commit();
  context.publish({{"format", format.name},
                   {"folder", folder.string()},
                   {"frames", dataset.frames.size()},
                   {"points", dataset.points.size()}},
                  fmt::format("written  {}: {} images, {} points\n", folder.string(),
                              dataset.frames.size(), dataset.points.size()));
}

}  // namespace sheen::app
