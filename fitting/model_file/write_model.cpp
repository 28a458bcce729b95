// SPDX-License-Identifier: MIT
#include "core/atlas/atlas_vertices.h"
#include "core/diagnostics/error.h"
#include "core/files/write_file.h"
#include "core/image/srgb_curve.h"
#include "fitting/descriptor.h"
#include "fitting/model_file/checksum.h"
#include "fitting/model_file/document.h"
#include "fitting/model_file/glb.h"
#include "fitting/model_file/model_file.h"
#include "fitting/model_file/model_part.h"
#include "fitting/model_file/texture_image.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace sheen::fitting {
namespace {

using nlohmann::json;

template <typename T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

json as_json(const Eigen::Vector3f& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

// Our colours are display-referred, glTF's vertex colours are linear.
std::uint16_t linear_from_srgb(float srgb) {
  const float linear = core::linear_from_srgb(srgb);
  return static_cast<std::uint16_t>(std::lround(std::clamp(linear, 0.0f, 1.0f) * 65535.0f));
}

std::vector<std::array<std::uint16_t, 4>> linear_colours(const std::vector<Eigen::Vector3f>& srgb) {
  std::vector<std::array<std::uint16_t, 4>> colours;
  colours.reserve(srgb.size());
  for (const Eigen::Vector3f& colour : srgb) {
    colours.push_back({linear_from_srgb(colour.x()), linear_from_srgb(colour.y()),
                       linear_from_srgb(colour.z()), 65535});
  }
  return colours;
}

std::size_t add_colours(const std::vector<Eigen::Vector3f>& srgb, DocumentBuilder& builder) {
  const std::size_t colours = builder.add_accessor(bytes_of(linear_colours(srgb)), kArrayBuffer,
                                                   kUnsignedShort, "VEC4", srgb.size());
  builder.document["accessors"][colours]["normalized"] = true;
  return colours;
}

std::size_t add_places(const std::vector<core::AtlasPoint>& places, DocumentBuilder& builder) {
  const std::size_t accessor =
      builder.add_accessor(bytes_of(places), kArrayBuffer, kUnsignedShort, "VEC2", places.size());
  builder.document["accessors"][accessor]["normalized"] = true;
  return accessor;
}

json add_vertices(const core::Mesh& mesh, DocumentBuilder& builder) {
  const std::size_t vertices = mesh.positions.size();
  const std::size_t position =
      builder.add_accessor(bytes_of(mesh.positions), kArrayBuffer, kFloat, "VEC3", vertices);
  Eigen::Vector3f lowest = mesh.positions.front();
  Eigen::Vector3f highest = lowest;
  for (const Eigen::Vector3f& p : mesh.positions) {
    lowest = lowest.cwiseMin(p);
    highest = highest.cwiseMax(p);
  }
  builder.document["accessors"][position]["min"] = as_json(lowest);
  builder.document["accessors"][position]["max"] = as_json(highest);
  const std::size_t normal =
      builder.add_accessor(bytes_of(mesh.normals), kArrayBuffer, kFloat, "VEC3", vertices);
  return {{"POSITION", position}, {"NORMAL", normal}};
}

void add_triangles(const core::Mesh& mesh, const json& attributes, DocumentBuilder& builder) {
  const std::size_t indices =
      builder.add_accessor(bytes_of(mesh.triangles), kElementArrayBuffer, kUnsignedInt, "SCALAR",
                           3 * mesh.triangles.size());
  builder.document["meshes"] = {
      {{"primitives",
        {{{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", 4}}}}}};
}

/// What any glTF viewer shows: the mesh with its mean colours, unlit.
void add_coloured_mesh(const core::Mesh& mesh, const LightField& light_field,
                       DocumentBuilder& builder) {
  json attributes = add_vertices(mesh, builder);
  attributes["COLOR_0"] = add_colours(light_field.vertex_colours(mesh), builder);
  add_triangles(mesh, attributes, builder);
}

core::Mesh mesh_of(const core::Mesh& mesh, const core::AtlasVertices& split) {
  core::Mesh result;
  for (const std::uint32_t vertex : split.vertex) {
    result.positions.push_back(mesh.positions[vertex]);
    result.normals.push_back(mesh.normals[vertex]);
  }
  result.triangles = split.triangles;
  return result;
}

/// The same of a light field that has a texture: the mesh with it, vertices repeated where the
/// texture has a seam.
void add_textured_mesh(const core::Mesh& mesh, const SurfaceTexture& texture,
                       DocumentBuilder& builder) {
  const core::AtlasVertices split = core::split_at_seams(mesh, texture.atlas());
  const core::Mesh drawn = mesh_of(mesh, split);
  json attributes = add_vertices(drawn, builder);
  attributes["TEXCOORD_0"] = add_places(split.place, builder);
  add_triangles(drawn, attributes, builder);
  json& document = builder.document;
  const std::size_t image = builder.add_view(bytes_of(encode_texture(texture)));
  document["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}}};
  document["samplers"] = {{{"magFilter", kLinear},
                           {"minFilter", kLinear},
                           {"wrapS", kClampToEdge},
                           {"wrapT", kClampToEdge}}};
  document["textures"] = {{{"sampler", 0}, {"source", 0}}};
  document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  json& extension = document["extensions"][kExtension];
  extension["image"] = 0;
  const auto copies = std::span(split.vertex).subspan(mesh.positions.size());
  // glTF knows no empty bufferView.
  if (!copies.empty()) extension["copies"] = builder.add_view(std::as_bytes(copies));
}

void add_scene(json& document) {
  document["asset"] = {{"version", "2.0"}, {"generator", "sheen"}};
  document["scene"] = 0;
  document["scenes"] = {{{"nodes", {0}}}};
  document["nodes"] = {{{"mesh", 0}}};
  document["materials"] = {
      {{"extensions", {{"KHR_materials_unlit", json::object()}}},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}}};
  document["extensionsUsed"] = {"KHR_materials_unlit", kExtension};
}

/// Where the mesh's own coordinates lie, for a mesh far from its origin: the scene is where the
/// user's data are.
void add_offset(const Eigen::Vector3d& offset, json& document) {
  if (offset.isZero(0)) return;
  const json numbers = {offset.x(), offset.y(), offset.z()};
  document["nodes"][0]["translation"] = numbers;
  document["extensions"][kExtension]["offset"] = numbers;
}

void add_light_field(const LightField& light_field, const ModelPart& part,
                     DocumentBuilder& builder) {
  json arrays = json::object();
  for (const auto& [name, bytes] : part.arrays) arrays[name] = builder.add_view(bytes);
  json& extension = builder.document["extensions"][kExtension];
  extension.update({{"version", kExtensionVersion},
                    {"representation", light_field.representation()},
                    {"directionMap", kDirectionMap},
                    {"tangentFrame", kTangentFrame},
                    {"colorSpace", kColourSpace},
                    {"checksum", kChecksumPlaceholder},
                    {"parameters", part.parameters},
                    {"arrays", std::move(arrays)}});
  if (!part.observed.empty()) extension["observed"] = builder.add_view(part.observed);
}

}  // namespace

std::size_t byte_size(const LightField& light_field) {
  const ModelPart part = representation_named(light_field.representation()).encode(light_field);
  std::size_t bytes = part.observed.size();
  for (const auto& [name, array] : part.arrays) bytes += array.size();
  if (part.texture != nullptr) bytes += encode_texture(*part.texture).size();
  return bytes;
}

void write_model(const std::filesystem::path& path, const core::Mesh& mesh,
                 const LightField& light_field, const SeenDirections& seen) {
  assert(seen.empty() || seen.size() == mesh.positions.size());
  assert(!mesh.positions.empty() && !mesh.triangles.empty());
  DocumentBuilder builder;
  add_scene(builder.document);
  const ModelPart part = representation_named(light_field.representation()).encode(light_field);
  if (part.texture != nullptr) {
    add_textured_mesh(mesh, *part.texture, builder);
  } else {
    add_coloured_mesh(mesh, light_field, builder);
  }
  add_light_field(light_field, part, builder);
  if (!seen.empty()) {
    builder.document["extensions"][kExtension]["seen"] = builder.add_view(bytes_of(seen));
  }
  add_offset(mesh.offset, builder.document);
  builder.document["buffers"] = {{{"byteLength", builder.binary.size()}}};
  std::optional<std::string> bytes = glb_bytes(builder.document, builder.binary);
  if (!bytes) {
    throw core::Error(core::Error::Kind::run_failed, path,
                      "the model passes the 4 GiB that a glb file can hold",
                      "use fewer centres, fewer terms or a coarser mesh");
  }
  write_checksum(*bytes);
  core::write_file(path, *bytes);
}

}  // namespace sheen::fitting
