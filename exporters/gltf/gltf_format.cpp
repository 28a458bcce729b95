// SPDX-License-Identifier: MIT
#include "exporters/gltf/gltf_format.h"

#include "core/files/write_file.h"
#include "exporters/gltf/gltf_bytes.h"
#include "exporters/splats/splats.h"
#include "exporters/surface/mean_texture.h"
#include "exporters/surface/vertex_confidence.h"
#include "exporters/upright.h"

namespace sheen::exporters::gltf {
namespace {

constexpr std::string_view kEndings[] = {".glb"};

struct Options {
  std::string up = "z";
  bool splats = false;
  void check() const { check_up(up); }
};

fitting::OptionTable option_table(Options& options) {
  return {up_option(options.up),
          fitting::flag_option("splats", options.splats,
                               "Gaussian splats (KHR_gaussian_splatting) in place of the mesh")};
}

Written write(const fitting::Model& model, const std::filesystem::path& path,
              const fitting::FitOptions& given) {
  const auto& options = fitting::options_as<Options>(given);
  const Eigen::Matrix3f y_up = y_up_from_object(options.up);
  const auto confidence = vertex_confidence(model);
  if (options.splats) {
    const Splats splats = make_splats(model, y_up);
    core::write_file(path, splat_bytes(path, splats, confidence));
    return {.files = {path},
            .as_read = splat_model(model, splats, y_up),
            .remarks = splat_remarks(model)};
  }
  const fitting::SurfaceTexture texture = mean_texture(model);
  core::write_file(path, textured_bytes(path, turned(model.mesh, y_up), texture, confidence));
  return {.files = {path}, .as_read = textured_model(model, texture), .remarks = {}};
}

}  // namespace

constinit const Format kFormat{.name = "glTF",
                               .endings = kEndings,
                               .sentence = "mesh with a texture of mean radiance, or --splats",
                               .default_options = fitting::new_options<Options>,
                               .write = write};

}  // namespace sheen::exporters::gltf
