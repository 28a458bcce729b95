// SPDX-License-Identifier: MIT
#include "app/commands/view.h"

#include "app/preview/run_preview.h"
#include "fitting/model_file/model_file.h"
#include "fitting/patch_light_field.h"

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
  const auto numbers = static_cast<double>(light_field.coefficient_count());
  ModelFacts facts{{"file", options.model.filename().string()},
                   {"representation", std::string(light_field.representation())}};
  if (const auto* const model = fitting::as_patches(light_field)) {
    const auto patches = static_cast<double>(model->patch_count());
    const auto& observed = model->observed();
    const auto seen =
        static_cast<double>(std::count(observed.begin(), observed.end(), std::uint8_t{1}));
    facts.emplace_back("patches", fmt::format("{:.0f}", patches));
    facts.emplace_back("seen", fmt::format("{:.0f} %", 100 * seen / patches));
    facts.emplace_back("numbers a patch", fmt::format("{:.1f}", numbers / patches));
  } else {
    facts.emplace_back("numbers", fmt::format("{:.0f}", numbers));
  }
  const auto bytes = static_cast<double>(std::filesystem::file_size(options.model));
  facts.emplace_back("size", fmt::format("{:.1f} MB", 1e-6 * bytes));
  return facts;
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

void add_view_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<ViewOptions>();
  Command command = program.command("view", "Look at a light field in a window");
  command.example(
      "Left drag turns, right drag moves, the wheel comes nearer; H shows all keys.\n"
      "Example:\n  sheen view model.glb");
  command.option("model", options->model, "Model file").required().type("MODEL.glb");
  command.option("--snapshots", options->snapshots, "Folder for snapshots (F12)")
      .type("DIR")
      .show_default();
  add_common_options(command, context);
  command.action([options] { run_view(*options); });
}

}  // namespace sheen::app
