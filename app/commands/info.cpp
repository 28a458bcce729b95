// SPDX-License-Identifier: MIT
#include "app/commands/info.h"

#include "core/mesh/bounds.h"
#include "fitting/model_file/model_file.h"
#include "fitting/patch_light_field.h"
#include "fitting/state/state_file.h"
#include "fitting/texture/surface_texture.h"
#include "pipeline/session_mesh.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>

namespace sheen::app {
namespace {

nlohmann::ordered_json describe(const core::Mesh& mesh) {
  const Eigen::Vector3f size_mm = core::bounds_of(mesh).sizes() * 1000;
  return {{"vertices", mesh.positions.size()},
          {"triangles", mesh.triangles.size()},
          {"size_mm", {size_mm.x(), size_mm.y(), size_mm.z()}}};
}

nlohmann::ordered_json describe_session(const std::filesystem::path& folder) {
  const capture::Session session = capture::open_session(folder);
  const auto frames = capture::open_frames(session);
  const auto& camera = session.camera.intrinsics();
  nlohmann::ordered_json document{{"kind", "session"}};
  document["frames"] = frames->frame_count() ? nlohmann::ordered_json(*frames->frame_count())
                                             : nlohmann::ordered_json(nullptr);
  document["pictures"] =
      session.video ? session.video->filename().string() : session.image_pattern.value_or("");
  document["size_px"] = {camera.width_px, camera.height_px};
  document["focal_px"] = {camera.focal_px.x(), camera.focal_px.y()};
  if (session.depth) document["depth"] = session.depth->pattern;
  if (session.board) {
    const capture::Board board = capture::read_board(*session.board);
    document["board"] = {{"family", board.family}, {"tags", board.tags.size()}};
  }
  if (session.poses) document["poses"] = capture::read_trajectory(*session.poses).entries().size();
  if (!session.mesh.empty()) document["mesh"] = describe(pipeline::read_object_mesh(session.mesh));
  document["warnings"] = session.warnings;
  return document;
}

nlohmann::ordered_json describe_model(const std::filesystem::path& path) {
  const fitting::Model model = fitting::read_model(path);
  const fitting::LightField& light_field = *model.light_field;
  nlohmann::ordered_json document{{"kind", "model"},
                                  {"representation", light_field.representation()}};
  if (const auto* const patches = fitting::as_patches(light_field)) {
    const auto& observed = patches->observed();
    document["patches"] = patches->patch_count();
    document["patches_observed"] = std::count(observed.begin(), observed.end(), std::uint8_t{1});
    if (const auto* const texture = patches->texture_between_patches()) {
      document["texture_size"] = {texture->atlas().width, texture->atlas().height};
      document["texels_stored"] = texture->texel_count().stored;
      document["texels_offered"] = texture->texel_count().offered;
    }
    document["coefficients_per_patch"] =
        static_cast<double>(light_field.coefficient_count()) /
        static_cast<double>(std::max<std::size_t>(1, patches->patch_count()));
  }
  document["coefficients"] = light_field.coefficient_count();
  document["bytes"] = std::filesystem::file_size(path);
  document["mesh"] = describe(model.mesh);
  return document;
}

nlohmann::ordered_json describe_state(const std::filesystem::path& path) {
  const fitting::StateReader state(path);
  nlohmann::ordered_json document{{"kind", "state"},
                                  {"representation", state.header().representation},
                                  {"options", state.header().options},
                                  {"views", state.views().size()}};
  std::map<std::string, std::vector<int>> sessions;
  for (const fitting::StateView& view : state.views()) sessions[view.session].push_back(view.frame);
  for (const auto& [name, frames] : sessions) {
    document["sessions"][name] = {
        {"views", frames.size()}, {"first_frame", frames.front()}, {"last_frame", frames.back()}};
  }
  document["bytes"] = std::filesystem::file_size(path);
  document["mesh"] = describe(state.header().mesh);
  return document;
}

nlohmann::ordered_json describe_path(const std::filesystem::path& path) {
  std::error_code no_throw;
  if (std::filesystem::is_directory(path, no_throw)) return describe_session(path);
  return fitting::is_state(path) ? describe_state(path) : describe_model(path);
}

/// One "name  value" line per entry; nested entries on one line.
std::string to_text(const nlohmann::ordered_json& document) {
  std::string text;
  for (const auto& [name, value] : document.items()) {
    const std::string shown = value.is_string() ? value.get<std::string>() : value.dump();
    text += fmt::format("{:<24}{}\n", name, shown);
  }
  return text;
}

}  // namespace

void add_info_command(CommandLine& program, CommandContext& context) {
  auto path = std::make_shared<std::filesystem::path>();
  Command command = program.command("info", "Tell what a session, a model or a fit state holds");
  command.option("path", *path, "Session folder, model file or fit state").required();
  add_common_options(command, context);
  command.action([path, &context] {
    const nlohmann::ordered_json document = describe_path(*path);
    context.publish(document, to_text(document));
  });
}

}  // namespace sheen::app
