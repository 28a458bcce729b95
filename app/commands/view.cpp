// SPDX-License-Identifier: MIT
#include "app/commands/view.h"

#include "app/preview/run_preview.h"
#include "fitting/model_file/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace sheen::app {
namespace {

struct ViewOptions {
  std::filesystem::path model;
  std::filesystem::path snapshots = ".";
};

ModelFacts facts_of(const ViewOptions& options, const fitting::LightField& light_field) {
  const auto patches = static_cast<double>(light_field.patch_count());
  const auto& observed = light_field.observed();
  const auto seen =
      static_cast<double>(std::count(observed.begin(), observed.end(), std::uint8_t{1}));
  return {
      {"file", options.model.filename().string()},
      {"representation", std::string(light_field.representation())},
      {"patches", fmt::format("{}", light_field.patch_count())},
      {"seen", fmt::format("{:.0f} %", 100 * seen / patches)},
      {"numbers a patch",
       fmt::format("{:.1f}", static_cast<double>(light_field.coefficient_count()) / patches)},
      {"size", fmt::format("{:.1f} MB",
                           1e-6 * static_cast<double>(std::filesystem::file_size(options.model)))}};
}

void run_view(const ViewOptions& options) {
  const fitting::Model model = fitting::read_model(options.model);
  run_viewer({.title = options.model.filename().string() + " \u2013 Sheen",
              .mesh = model.mesh,
              .up = Eigen::Vector3d::UnitZ(),
              .light_field = model.light_field.get(),
              .facts = facts_of(options, *model.light_field),
              .snapshot_folder = options.snapshots});
}

}  // namespace

void add_view_command(CLI::App& program, CommandContext& context) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = program.add_subcommand("view", "Look at a light field in a window");
  command->footer(
      "Left drag turns, right drag moves, the wheel comes nearer; H shows all keys.\n"
      "Example:\n  sheen view model.glb");
  command->add_option("model", options->model, "Model file")->required()->type_name("MODEL.glb");
  command->add_option("--snapshots", options->snapshots, "Folder for snapshots (F12)")
      ->type_name("DIR")
      ->capture_default_str();
  add_common_options(*command, context);
  command->callback([options] { run_view(*options); });
}

}  // namespace sheen::app
