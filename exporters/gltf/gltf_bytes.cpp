// SPDX-License-Identifier: MIT
#include "exporters/gltf/gltf_bytes.h"

#include "core/atlas/atlas_vertices.h"
#include "core/diagnostics/error.h"
#include "exporters/linear_colour.h"
#include "fitting/model_file/document.h"
#include "fitting/model_file/glb.h"
#include "fitting/model_file/texture_image.h"

#include <span>

namespace sheen::exporters::gltf {
namespace {

using fitting::DocumentBuilder;
using nlohmann::json;

/// One element of the accessor for each value.
template <typename Value>
std::size_t add_numbers(DocumentBuilder& builder, const std::vector<Value>& values,
                        unsigned component, const char* type) {
  return builder.add_accessor(std::as_bytes(std::span(values)), fitting::kArrayBuffer, component,
                              type, values.size());
}

json numbers(const Eigen::Vector3f& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

std::size_t add_positions(DocumentBuilder& builder, const std::vector<Eigen::Vector3f>& positions) {
  const std::size_t accessor = add_numbers(builder, positions, fitting::kFloat, "VEC3");
  Eigen::Vector3f lowest = positions.front();
  Eigen::Vector3f highest = lowest;
  for (const Eigen::Vector3f& p : positions) {
    lowest = lowest.cwiseMin(p);
    highest = highest.cwiseMax(p);
  }
  builder.document["accessors"][accessor]["min"] = numbers(lowest);
  builder.document["accessors"][accessor]["max"] = numbers(highest);
  return accessor;
}

/// `vertex`: of the mesh, that each point stands for.
void add_confidence(DocumentBuilder& builder, const std::vector<core::VertexConfidence>& confidence,
                    const std::vector<std::uint32_t>& vertex, json& attributes) {
  if (confidence.empty()) return;
  std::vector<float> means;
  std::vector<std::uint64_t> seen;  // four numbers of 16 bits, little-endian as the file
  for (const std::uint32_t index : vertex) {
    means.push_back(confidence[index].mean);
    seen.push_back(confidence[index].seen);
  }
  attributes["_CONFIDENCE"] = add_numbers(builder, means, fitting::kFloat, "SCALAR");
  attributes["_SEEN"] = add_numbers(builder, seen, fitting::kUnsignedShort, "VEC4");
}

void begin_scene(DocumentBuilder& builder, const Eigen::Vector3d& offset) {
  builder.document = {{"asset", {{"version", "2.0"}, {"generator", "sheen"}}},
                      {"scene", 0},
                      {"scenes", {{{"nodes", {0}}}}},
                      {"nodes", {{{"mesh", 0}}}}};
  if (offset.isZero(0)) return;
  builder.document["nodes"][0]["translation"] = {offset.x(), offset.y(), offset.z()};
}

std::string finished(const std::filesystem::path& path, DocumentBuilder& builder) {
  builder.document["buffers"] = {{{"byteLength", builder.binary.size()}}};
  std::optional<std::string> bytes = fitting::glb_bytes(builder.document, builder.binary);
  if (bytes) return *std::move(bytes);
  throw core::Error(core::Error::Kind::run_failed, path, "would pass the 4 GiB of a glb file",
                    "fit a coarser mesh");
}

}  // namespace

std::string textured_bytes(const std::filesystem::path& path, const core::Mesh& mesh,
                           const fitting::SurfaceTexture& texture,
                           const std::vector<core::VertexConfidence>& confidence) {
  const core::AtlasVertices split = core::split_at_seams(mesh, texture.atlas());
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  for (const std::uint32_t vertex : split.vertex) {
    positions.push_back(mesh.positions[vertex]);
    normals.push_back(mesh.normals[vertex]);
  }
  DocumentBuilder builder;
  begin_scene(builder, mesh.offset);
  json& document = builder.document;
  json attributes{{"POSITION", add_positions(builder, positions)}};
  attributes["NORMAL"] = add_numbers(builder, normals, fitting::kFloat, "VEC3");
  const std::size_t places = add_numbers(builder, split.place, fitting::kUnsignedShort, "VEC2");
  document["accessors"][places]["normalized"] = true;
  attributes["TEXCOORD_0"] = places;
  add_confidence(builder, confidence, split.vertex, attributes);
  const std::size_t indices =
      builder.add_accessor(std::as_bytes(std::span(split.triangles)), fitting::kElementArrayBuffer,
                           fitting::kUnsignedInt, "SCALAR", 3 * split.triangles.size());
  document["meshes"] = {
      {{"primitives",
        {{{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", 4}}}}}};
  const auto png = fitting::encode_texture(texture);
  const std::size_t image = builder.add_view(std::as_bytes(std::span(png)));
  document["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}}};
  document["samplers"] = {{{"magFilter", fitting::kLinear},
                           {"minFilter", fitting::kLinear},
                           {"wrapS", fitting::kClampToEdge},
                           {"wrapT", fitting::kClampToEdge}}};
  document["textures"] = {{{"sampler", 0}, {"source", 0}}};
  document["materials"] = {
      {{"extensions", {{"KHR_materials_unlit", json::object()}}},
       {"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}}};
  document["extensionsUsed"] = {"KHR_materials_unlit"};
  return finished(path, builder);
}

std::string splat_bytes(const std::filesystem::path& path, const Splats& splats,
                        const std::vector<core::VertexConfidence>& confidence) {
  DocumentBuilder builder;
  begin_scene(builder, splats.offset);
  const std::size_t count = splats.splats.size();
  std::vector<Eigen::Vector3f> positions(count);
  std::vector<Eigen::Vector3f> sigmas(count);
  std::vector<Eigen::Vector4f> rotations(count);
  std::vector<Eigen::Vector4f> colours(count);
  std::vector<float> opacities(count);
  std::vector<Eigen::Vector3f> harmonics(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Splat& splat = splats.splats[i];
    positions[i] = splat.position;
    sigmas[i] = splat.sigma;
    rotations[i] = splat.rotation.coeffs();  // x y z w
    opacities[i] = splat.opacity;
    const Eigen::Vector3f linear = splat.mean_colour().unaryExpr(&linear_from_srgb);
    colours[i] = {linear.x(), linear.y(), linear.z(), splat.opacity};
  }
  const auto add = [&](const auto& values, const char* type) {
    return add_numbers(builder, values, fitting::kFloat, type);
  };
  const std::string prefix = "KHR_gaussian_splatting:";
  json attributes{{"POSITION", add_positions(builder, positions)}};
  attributes["COLOR_0"] = add(colours, "VEC4");
  attributes[prefix + "ROTATION"] = add(rotations, "VEC4");
  attributes[prefix + "SCALE"] = add(sigmas, "VEC3");
  attributes[prefix + "OPACITY"] = add(opacities, "SCALAR");
  std::size_t term = 0;
  for (int degree = 0; degree <= 3; ++degree) {
    for (int order = 0; order <= 2 * degree; ++order, ++term) {
      for (std::size_t i = 0; i < count; ++i) harmonics[i] = splats.splats[i].harmonics[term];
      attributes[prefix + "SH_DEGREE_" + std::to_string(degree) + "_COEF_" +
                 std::to_string(order)] = add(harmonics, "VEC3");
    }
  }
  add_confidence(builder, confidence, splats.vertex, attributes);
  const json extension{{"kernel", "ellipse"},
                       {"colorSpace", "srgb_rec709_display"},
                       {"projection", "perspective"},
                       {"sortingMethod", "cameraDistance"}};
  builder.document["meshes"] = {{{"primitives",
                                  {{{"attributes", attributes},
                                    {"mode", 0},
                                    {"extensions", {{"KHR_gaussian_splatting", extension}}}}}}}};
  builder.document["extensionsUsed"] = {"KHR_gaussian_splatting"};
  return finished(path, builder);
}

}  // namespace sheen::exporters::gltf
