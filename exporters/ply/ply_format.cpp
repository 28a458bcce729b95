// SPDX-License-Identifier: MIT
#include "exporters/ply/ply_format.h"

#include "core/mesh/coloured_ply.h"
#include "exporters/surface/mean_texture.h"
#include "exporters/surface/vertex_confidence.h"

namespace sheen::exporters::ply {
namespace {

constexpr std::string_view kEndings[] = {".ply"};

Written write(const fitting::Model& model, const std::filesystem::path& path,
              const fitting::FitOptions& /*options*/) {
  const auto colours = model.light_field->vertex_colours(model.mesh);
  core::write_coloured_ply(path, model.mesh, colours, vertex_confidence(model));
  return {.files = {path}, .as_read = coloured_model(model, colours), .remarks = {}};
}

}  // namespace

constinit const Format kFormat{
    .name = "PLY mesh",
    .endings = kEndings,
    .sentence = "mesh with normals, mean colours and confidence of its vertices",
    .default_options = fitting::new_options<fitting::NoOptions>,
    .write = write};

}  // namespace sheen::exporters::ply
