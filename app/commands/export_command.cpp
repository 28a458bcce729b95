// SPDX-License-Identifier: MIT
#include "app/commands/export_command.h"

#include "app/commands/export_cost.h"
#include "app/commands/frame_options.h"
#include "exporters/format.h"
#include "fitting/model_file/model_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace sheen::app {
namespace {

struct ExportOptions {
  std::filesystem::path model;
  std::filesystem::path output;
  fitting::OptionValues given;    ///< of the format
  std::filesystem::path session;  ///< whose views the conversion is measured on; empty: none
  pipeline::FrameChoice frames;
};

/// Settings of all formats by name: the format that each belongs to, for the help.
struct FormatOption {
  fitting::FitOption option;
  std::vector<std::string> owners;  ///< endings
};

std::vector<FormatOption> format_options() {
  std::vector<FormatOption> known;
  for (const exporters::Format* format : exporters::formats()) {
    const auto options = format->default_options();
    for (fitting::FitOption& option : options->table()) {
      auto same = std::ranges::find_if(
          known, [&](const FormatOption& k) { return k.option.name == option.name; });
      if (same == known.end()) {
        // The help needs the default's text, not the options it stands in.
        const std::string default_text = option.get();
        option.get = [default_text] { return default_text; };
        option.set = {};
        same = known.insert(known.end(), {std::move(option), {}});
      }
      same->owners.emplace_back(format->endings.front());
    }
  }
  return known;
}

std::string help_of(const FormatOption& known) {
  std::string text = fmt::format("With {}: {}", fmt::join(known.owners, ", "), known.option.help);
  if (const std::string shown = known.option.get(); !shown.empty() && !known.option.is_flag()) {
    text += " (default " + shown + ")";
  }
  return text;
}

void run_export(const ExportOptions& options, const CommandContext& context) {
  // Settle what is asked for.
  const exporters::Format& format = exporters::format_of(options.output);
  const auto settings = format.default_options();
  fitting::apply(options.given, format.name, settings->table());
  settings->check();
  context.check_outputs({options.output});

  // Convert.
  const fitting::Model model = fitting::read_model(options.model);
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

}  // namespace

void add_export_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<ExportOptions>();
  Command command = program.command("export", "Write a model for other programs");
  std::string formats = "The ending says what is written:\n";
  for (const exporters::Format* format : exporters::formats()) {
    formats += fmt::format("  {:<12}{}\n", fmt::join(format->endings, ", "), format->sentence);
  }
  command.example(formats +
                  "Example:\n  sheen export model.glb -o viewer.html --title \"My vase\"");
  command.option("model", options->model, "Model file (.glb)").required();
  command.option("-o,--output", options->output, "File to write").required().type("FILE");
  command
      .option("--views", options->session,
              "Also measure what the conversion costs on the views of this session")
      .type("SESSION");
  command
      .option("--hold-out", options->frames.hold_out,
              "Only the frames that replay --hold-out N kept out; 0: all")
      .not_negative()
      .show_default();
  add_frame_options(command, options->frames);
  for (const FormatOption& known : format_options()) {
    const std::string name = known.option.name;
    const auto take = [options, name](const std::string& text) { options->given[name] = text; };
    if (known.option.is_flag()) {
      command.switch_on(
          "--" + name, [take] { take("true"); }, help_of(known));
    } else {
      command.option("--" + name, take, help_of(known)).type(known.option.type);
    }
  }
  add_common_options(command, context);
  command.action([options, &context] { run_export(*options, context); });
}

}  // namespace sheen::app
