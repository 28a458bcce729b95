// SPDX-License-Identifier: MIT
#include "app/commands/export_command.h"

#include "app/commands/export_cost.h"
#include "app/commands/export_dataset.h"
#include "app/commands/frame_options.h"
#include "app/commands/poster.h"
#include "app/commands/table_options.h"
#include "core/diagnostics/error.h"
#include "exporters/format.h"
#include "exporters/viewer/viewer_format.h"
#include "fitting/model_file/model_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sheen::app {
namespace {

struct ExportOptions {
  std::filesystem::path source;  ///< a model, or a session
  std::filesystem::path output;
  fitting::OptionValues given;    ///< of the format
  std::filesystem::path session;  ///< whose views the conversion is measured on; empty: none
  pipeline::FrameChoice frames;
  DatasetExport dataset;  ///< where the source is a session
};

/// The settings of all formats, which the help names by their endings.
std::vector<OwnedOption> format_options() {
  std::vector<OwnedOption> known;
  for (const exporters::Format* format : exporters::formats()) {
    add_owner(format->endings.front(), *format->default_options(), known);
  }
  return known;
}

void export_model(const ExportOptions& options, const CommandContext& context) {
  // Settle what is asked for.
  const exporters::Format& format = exporters::format_of(options.output);
  const auto settings = format.default_options();
  fitting::apply(options.given, format.name, settings->table());
  settings->check();
  context.check_outputs({options.output});
  std::error_code absent;
  if (std::filesystem::equivalent(options.source, options.output, absent)) {
    throw core::bad_input(options.output, "is the model itself, which holds more than any export",
                          "choose another name for the file");
  }

  // Convert.
  const fitting::Model model = fitting::read_model(options.source);
  if (&format == &exporters::viewer::kFormat) {
    draw_missing_poster(model, fitting::options_as<exporters::viewer::Options>(*settings), context);
  }
  const exporters::Written written = format.write(model, options.output, *settings);

  // Report.
  nlohmann::ordered_json document{{"format", format.name}};
  std::string text;
  for (const std::filesystem::path& file : written.files) {
    const auto bytes = std::filesystem::file_size(file);
    document["files"].push_back({{"path", file.string()}, {"bytes", bytes}});
    text +=
        fmt::format("written  {} ({:.2f} MB)\n", file.string(), static_cast<double>(bytes) / 1e6);
  }
  if (written.as_read) {
    const ConversionCost cost =
        conversion_cost(model, *written.as_read, options.session, options.frames, context);
    document["cost"] = to_json(cost);
    text += to_text(cost);
  }
  for (const std::string& remark : written.remarks) context.note(remark);
  context.publish(document, text);
}

void run_export(const ExportOptions& options, const CommandContext& context) {
  std::error_code no_throw;
  const bool is_session = std::filesystem::is_directory(options.source, no_throw);
  if (is_session) {
    export_dataset(options.source, options.output, options.dataset, options.frames, context);
    return;
  }
  if (!options.dataset.format.empty() || options.dataset.undistort) {
    throw UsageError("--format and --undistort are for sessions, " + options.source.string() +
                     " is no folder");
  }
  export_model(options, context);
}

}  // namespace

void add_export_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<ExportOptions>();
  Command command =
      program.command("export", "Write a model, or a session as a data set, for other programs");
  std::string formats = "A model becomes a file, whose ending says what is written:\n";
  for (const exporters::Format* format : exporters::formats()) {
    formats += fmt::format("  {:<12}{}\n", fmt::join(format->endings, ", "), format->sentence);
  }
  command.example(formats + dataset_formats_help() +
                  "Examples:\n  sheen export model.glb -o viewer.html --title \"My vase\"\n"
                  "  sheen export SESSION -o DIR --format nerfstudio --undistort");
  command.option("source", options->source, "Model file (.glb), or a session's folder").required();
  command.option("-o,--output", options->output, "File or folder to write").required().type("FILE");
  command.option("--format", options->dataset.format, "Of a session's data set")
      .one_of(written_dataset_formats());
  command.flag("--undistort", options->dataset.undistort,
               "Images of a data set as a camera without distortion would have taken them");
  command
      .option("--views", options->session,
              "Also measure what the conversion costs on the views of this session")
      .type("SESSION");
  add_evaluated_frame_options(command, options->frames);
  add_table_options(
      command, format_options(),
      [options](const std::string& name, const std::string& text) { options->given[name] = text; });
  add_common_options(command, context);
  command.action([options, &context] { run_export(*options, context); });
}

}  // namespace sheen::app
