// SPDX-License-Identifier: MIT
#include "app/commands/import.h"

#include "app/terminal_sink.h"
#include "capture/calibration/camera_file.h"
#include "capture/dataset/board_alignment.h"
#include "capture/dataset/dataset_formats.h"
#include "capture/dataset/import_session.h"
#include "capture/session/session.h"
#include "core/diagnostics/error.h"
#include "pipeline/session_mesh.h"

#include <fmt/format.h>

namespace sheen::app {
namespace {

struct ImportOptions {
  std::filesystem::path dataset;
  std::filesystem::path images;
  std::filesystem::path mesh;
  std::filesystem::path session;
  std::filesystem::path camera;  ///< in place of the data set's; empty: none
  double metres_per_unit = 1;
  std::vector<double> known_distance;  ///< units of the poses, metres; empty: none
  std::filesystem::path board;         ///< of tags that the images show; empty: none
  bool mesh_has_unit = false;
};

double metres_per_unit(const ImportOptions& options) {
  if (options.known_distance.empty()) return options.metres_per_unit;
  if (!(options.known_distance[0] > 0) || !(options.known_distance[1] > 0)) {
    throw UsageError("--known-distance takes a distance in units of the poses and in metres");
  }
  return options.known_distance[1] / options.known_distance[0];
}

/// The data set, by the camera that the user names where one is named.
capture::Dataset read_dataset(const ImportOptions& options, const std::filesystem::path& images) {
  capture::Dataset dataset = capture::read_dataset(options.dataset, images);
  if (options.camera.empty()) return dataset;
  dataset.cameras = {capture::read_camera(options.camera)};
  for (capture::DatasetFrame& frame : dataset.frames) frame.camera = 0;
  return dataset;
}

/// Notes what the commands that read the session would refuse or doubt. The session stands: its
/// mesh may still be registered, and only its user knows which of two units is wrong.
void note_doubts(const std::filesystem::path& folder, const CommandContext& context) {
  TerminalSink sink(context);
  try {
    capture::Session session = capture::open_session(folder);
    const core::Mesh mesh = pipeline::read_session_mesh(session, sink);
    pipeline::SessionScene scene(session, mesh, pipeline::PoseSource::file, sink);
    for (const Eigen::Isometry3d& pose : pipeline::probe_poses(session, {})) scene.see(pose);
    scene.finish(sink);
  } catch (const core::Error& error) {
    sink.note(error.what());
  }
}

void run_import(const ImportOptions& options, const CommandContext& context) {
  context.check_outputs({options.session});
  const std::filesystem::path images =
      options.images.empty() ? capture::images_of_dataset(options.dataset) : options.images;
  capture::SessionImport import{.dataset = read_dataset(options, images),
                                .images = images,
                                .mesh = options.mesh,
                                .metres_per_unit = metres_per_unit(options),
                                .mesh_has_unit = options.mesh_has_unit,
                                .board = options.board};
  const std::size_t count = import.dataset.frames.size();
  nlohmann::ordered_json document{{"session", options.session.string()}, {"frames", count}};
  std::string text = fmt::format("{}: {} images\n", options.session.string(), count);
  if (!options.board.empty()) {
    const auto alignment = capture::align_to_board(import.dataset, images, options.board);
    import.metres_per_unit = alignment.metres_per_unit;
    import.board_from_world = alignment.board_from_world;
    document["metres_per_unit"] = alignment.metres_per_unit;
    document["aligned"] = {{"images", alignment.images}, {"rms_m", alignment.rms_m}};
    text += fmt::format("a unit is {:.6g} m, by the tags in {} images; cameras within {:.2f} mm\n",
                        alignment.metres_per_unit, alignment.images, 1000 * alignment.rms_m);
  }
  capture::write_imported_session(import, options.session);
  note_doubts(options.session, context);
  context.publish(document, text);
}

}  // namespace

void add_import_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<ImportOptions>();
  Command command =
      program.command("import", "Make a session of images that another program has posed");
  std::string formats;
  for (const capture::DatasetFormat* format : capture::dataset_formats()) {
    formats += fmt::format("  {:<12}{}\n", format->name, format->sentence);
  }
  command.example(
      "Examples:\n"
      "  sheen import CAPTURE/transforms.json --mesh object.ply -o SESSION\n"
      "  sheen import PROJECT --mesh object.ply --scale 0.1 -o SESSION        a unit is 10 cm\n"
      "  sheen import bundle.out --mesh mesh.ply --known-distance 2.31 0.08 --scale-mesh -o "
      "SESSION\n"
      "Formats:\n" +
      formats +
      "The mesh has the axes of the poses and is in metres; sheen register improves its place.");
  command
      .option("dataset", options->dataset,
              "transforms.json, bundle.out, cameras.xml, or a folder with a transforms.json or a "
              "COLMAP model")
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
  command
      .option("--camera", options->camera,
              "the camera, in place of the data set's: of OpenCV, ROS (camera_info), Kalibr "
              "(camchain), Agisoft")
      .type("FILE");
  const Option scale =
      command.option("--scale", options->metres_per_unit, "metres per unit of the poses")
          .positive()
          .show_default();
  const Option known =
      command
          .option("--known-distance", options->known_distance,
                  "a distance in units of the poses and in metres, in place of --scale")
          .numbers(2)
          .excludes(scale);
  command
      .option("--board", options->board,
              "board.yaml of tags that the images show: scale and place follow from them")
      .type("FILE")
      .excludes(scale)
      .excludes(known);
  command.flag("--scale-mesh", options->mesh_has_unit,
               "the mesh is in the unit of the poses, too: scale it with them");
  add_common_options(command, context);
  command.action([options, &context] { run_import(*options, context); });
}

}  // namespace sheen::app
