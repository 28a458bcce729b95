// SPDX-License-Identifier: MIT
#include "app/commands/bake.h"

#include "app/commands/table_options.h"
#include "app/state/joined_model.h"
#include "core/diagnostics/error.h"
#include "core/mesh/read_mesh.h"
#include "fitting/billboard/bake.h"
#include "fitting/descriptor.h"
#include "fitting/model_file/model_file.h"
#include "render/billboard/bake_drawn.h"

#include <fmt/format.h>

namespace sheen::app {
namespace {

using fitting::billboard::Billboards;

/// What is baked is given, not fitted.
constexpr const char* kBakedFrom = "baked-from";

struct BakeOptions {
  std::filesystem::path source;
  std::filesystem::path output;
  fitting::OptionValues given;  ///< of the billboards
};

std::vector<OwnedOption> billboard_options() {
  std::vector<OwnedOption> known;
  const auto& descriptor = fitting::representation_named("billboard");
  add_owner(descriptor.name, *descriptor.default_options(), known);
  std::erase_if(known, [](const OwnedOption& one) { return one.option.name == kBakedFrom; });
  return known;
}

/// A mesh with the colours of its vertices, as a light field.
fitting::Model read_coloured_mesh(const std::filesystem::path& path,
                                  const CommandContext& context) {
  std::vector<std::string> notes;
  std::vector<Eigen::Vector3f> colours;
  fitting::Model model;
  model.mesh = core::read_mesh(path, &notes, &colours);
  for (const std::string& note : notes) context.note(path.string() + ": " + note);
  if (colours.empty()) {
    throw core::bad_input(path, "has no colours",
                          "give a mesh with colours at its vertices (PLY, OBJ), with colours or "
                          "materials (GLB), or a model that sheen wrote");
  }
  auto means = std::make_unique<fitting::mean::MeanLightField>(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i) means->store(i, colours[i], true);
  model.light_field = std::move(means);
  return model;
}

fitting::Model read_source(const std::filesystem::path& path, const CommandContext& context) {
  return fitting::is_model(path) ? fitting::read_model(path) : read_coloured_mesh(path, context);
}

void run_bake(const BakeOptions& options, const CommandContext& context) {
  // Settle what is asked for.
  const auto settings =
      fitting::options_from(fitting::representation_named("billboard"), options.given);
  context.check_outputs({options.output});
  std::error_code absent;
  if (std::filesystem::equivalent(options.source, options.output, absent)) {
    throw core::bad_input(options.output, "is the model itself, which holds more than billboards",
                          "choose another name for the file");
  }

  // Bake: patches themselves, anything else as it is drawn.
  const fitting::Model model = read_source(options.source, context);
  Billboards billboards(fitting::options_as<fitting::billboard::Options>(*settings),
                        fitting::billboard::bounding_sphere(model.mesh),
                        model.mesh.positions.size());
  if (const auto* const patches = fitting::as_patches(*model.light_field)) {
    fitting::billboard::bake_all(model.mesh, core::tangent_frames(model.mesh), *patches,
                                 context.threads, billboards);
  } else {
    const auto gl = render::make_osmesa_context();
    const auto renderer =
        render::make_renderer(*gl, model.mesh, *model.light_field, context.threads);
    render::bake_drawn(model.mesh, *model.light_field, *renderer, billboards);
  }

  // Report.
  fitting::write_model(options.output, model.mesh, billboards, model.seen);
  const auto bytes = std::filesystem::file_size(options.output);
  context.publish({{"representation", billboards.representation()},
                   {"baked_from", model.light_field->representation()},
                   {"frames", billboards.element_count()},
                   {"files", {{{"path", options.output.string()}, {"bytes", bytes}}}}},
                  fmt::format("written  {} ({:.2f} MB), {} frames\n", options.output.string(),
                              static_cast<double>(bytes) / 1e6, billboards.element_count()));
}

}  // namespace

void add_bake_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<BakeOptions>();
  Command command =
      program.command("bake", "Make billboards of a finished model, or of a mesh with colours");
  command.example(
      "A light field of patches gives what sheen replay --representation billboard --baked-from\n"
      "bakes of the same one, byte by byte; any other is baked as it is drawn.\n"
      "Examples:\n"
      "  sheen bake model.glb -o billboards.glb --directions 1280\n"
      "  sheen bake statue.ply -o billboards.glb");
  command
      .option("source", options->source,
              "Model file (.glb), or a mesh with colours (.ply, .obj, .glb)")
      .required();
  command.option("-o,--output", options->output, "Model of billboards to write (.glb)")
      .required()
      .check(fault_of_model_name)
      .type("MODEL.glb");
  add_table_options(
      command, billboard_options(),
      [options](const std::string& name, const std::string& text) { options->given[name] = text; });
  add_common_options(command, context);
  command.action([options, &context] { run_bake(*options, context); });
}

}  // namespace sheen::app
