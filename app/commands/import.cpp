// SPDX-License-Identifier: MIT
#include "app/commands/import.h"

#include "capture/dataset/dataset_formats.h"
#include "capture/dataset/import_session.h"

#include <fmt/format.h>

namespace sheen::app {
namespace {

struct ImportOptions {
  std::filesystem::path dataset;
  std::filesystem::path images;
  std::filesystem::path mesh;
  std::filesystem::path session;
  double metres_per_unit = 1;
};

/// Names in transforms.json are relative to it; COLMAP's are relative to an image folder.
std::filesystem::path folder_of_images(const ImportOptions& options) {
  if (!options.images.empty()) return options.images;
  if (!std::filesystem::is_directory(options.dataset)) return options.dataset.parent_path();
  if (std::filesystem::exists(options.dataset / "transforms.json")) return options.dataset;
  return options.dataset / "images";
}

void run_import(const ImportOptions& options, const CommandContext& context) {
  context.check_outputs({options.session});
  const capture::SessionImport import{.dataset = capture::read_dataset(options.dataset),
                                      .images = folder_of_images(options),
                                      .mesh = options.mesh,
                                      .metres_per_unit = options.metres_per_unit};
  capture::write_imported_session(import, options.session);
  const std::size_t count = import.dataset.frames.size();
  context.publish({{"session", options.session.string()}, {"frames", count}},
                  fmt::format("{}: {} images\n", options.session.string(), count));
}

}  // namespace

void add_import_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<ImportOptions>();
  Command command =
      program.command("import", "Make a session of images that another program has posed");
  command.example(
      "Examples:\n"
      "  sheen import CAPTURE/transforms.json --mesh object.ply -o SESSION    nerfstudio, "
      "instant-ngp\n"
      "  sheen import PROJECT --mesh object.ply --scale 0.1 -o SESSION        COLMAP, a unit is "
      "10 cm\n"
      "The mesh has the axes of the poses and is in metres; sheen register improves its place.");
  command
      .option("dataset", options->dataset,
              "transforms.json, or a folder with one or with a COLMAP model (text or binary)")
      .type("DATASET")
      .required();
  command.option("--mesh", options->mesh, "the object: PLY, OBJ or GLB in metres")
      .type("FILE")
      .required();
  command.option("-o,--output", options->session, "the session folder to write")
      .type("SESSION")
      .required();
  command.option("--images", options->images, "the folder that the images' names are relative to")
      .type("FOLDER");
  command.option("--scale", options->metres_per_unit, "metres per unit of the poses")
      .positive()
      .show_default();
  add_common_options(command, context);
  command.action([options, &context] { run_import(*options, context); });
}

}  // namespace sheen::app
