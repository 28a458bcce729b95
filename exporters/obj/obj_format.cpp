// SPDX-License-Identifier: MIT
#include "exporters/obj/obj_format.h"

#include "core/atlas/atlas_vertices.h"
#include "core/files/write_file.h"
#include "exporters/surface/mean_texture.h"
#include "exporters/upright.h"
#include "fitting/model_file/texture_image.h"

#include <fmt/format.h>

#include <cctype>
#include <iterator>

namespace sheen::exporters::obj {
namespace {

constexpr std::string_view kEndings[] = {".obj"};

/// Names of the other files; readers of OBJ part names at spaces.
std::string plain_stem(const std::filesystem::path& path) {
  std::string stem = path.stem().string();
  for (char& letter : stem) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-' ||
                          letter == '.' || letter == '_';
    if (!is_plain) letter = '_';
  }
  return stem;
}

std::string obj_text(const core::Mesh& mesh, const core::AtlasVertices& split,
                     const std::string& stem) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "mtllib {}.mtl\no surface\n", stem);
  for (const Eigen::Vector3f& position : mesh.positions) {
    const Eigen::Vector3d p = position.cast<double>() + mesh.offset;
    fmt::format_to(out, "v {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
  }
  for (const Eigen::Vector3f& n : mesh.normals) {
    fmt::format_to(out, "vn {:.6g} {:.6g} {:.6g}\n", n.x(), n.y(), n.z());
  }
  // OBJ counts upwards from the lower edge of the image.
  for (const core::AtlasPoint& place : split.place) {
    fmt::format_to(out, "vt {:.7g} {:.7g}\n", place.u / 65535.0, 1 - place.v / 65535.0);
  }
  text += "usemtl surface\n";
  for (const auto& triangle : split.triangles) {
    text += 'f';
    for (const std::uint32_t corner : triangle) {
      const std::uint32_t vertex = split.vertex[corner] + 1;
      fmt::format_to(out, " {}/{}/{}", vertex, corner + 1, vertex);
    }
    text += '\n';
  }
  return text;
}

Written write(const fitting::Model& model, const std::filesystem::path& path,
              const fitting::FitOptions& options) {
  const auto& up = fitting::options_as<UprightOptions>(options).up;
  const fitting::SurfaceTexture texture = mean_texture(model);
  const core::AtlasVertices split = core::split_at_seams(model.mesh, texture.atlas());
  const std::string stem = plain_stem(path);
  const auto material = path.parent_path() / (stem + ".mtl");
  const auto image = path.parent_path() / (stem + ".png");
  const auto png = fitting::encode_texture(texture);
  core::write_file(image, {reinterpret_cast<const char*>(png.data()), png.size()});
  // The texture is all the light there is: shown as it is, without a lamp.
  core::write_file(material, fmt::format("newmtl surface\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 0\n"
                                         "map_Kd {}.png\n",
                                         stem));
  core::write_file(path, obj_text(turned(model.mesh, y_up_from_object(up)), split, stem));
  return {
      .files = {path, material, image}, .as_read = textured_model(model, texture), .remarks = {}};
}

}  // namespace

constinit const Format kFormat{
    .name = "OBJ mesh",
    .endings = kEndings,
    .sentence = "mesh with a texture of mean radiance (.mtl, .png beside it)",
    .default_options = fitting::new_options<UprightOptions>,
    .write = write};

}  // namespace sheen::exporters::obj
