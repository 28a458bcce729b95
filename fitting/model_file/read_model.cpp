// SPDX-License-Identifier: MIT
#include "core/atlas/atlas_vertices.h"
#include "core/diagnostics/error.h"
#include "fitting/descriptor.h"
#include "fitting/model_file/checksum.h"
#include "fitting/model_file/document.h"
#include "fitting/model_file/glb.h"
#include "fitting/model_file/model_file.h"
#include "fitting/model_file/model_part.h"
#include "fitting/model_file/texture_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>

namespace sheen::fitting {
namespace {

using nlohmann::json;

std::string read_bytes(const std::filesystem::path& path) {
  // A pipe would wait for ever.
  std::error_code no_throw;
  if (!std::filesystem::is_regular_file(path, no_throw)) throw ModelFault("it is no file");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size < 0) throw ModelFault("it cannot be opened");
  if (size > static_cast<std::streamoff>(std::numeric_limits<std::uint32_t>::max())) {
    throw ModelFault("it is larger than a glb file can be");
  }
  std::string bytes(static_cast<std::size_t>(size), '\0');
  file.seekg(0);
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file) throw ModelFault("it cannot be read to its end");
  return bytes;
}

const json& element(const json& document, const char* list, std::size_t idx) {
  const json& elements = required(document, list);
  if (!elements.is_array() || idx >= elements.size()) {
    throw ModelFault(std::string("its \"") + list + "\" has no entry " + std::to_string(idx));
  }
  return elements[idx];
}

// Bytes of a bufferView, checked against the file.
std::span<const std::byte> view_bytes(const Glb& glb, std::size_t view_idx) {
  const json& view = element(glb.document, "bufferViews", view_idx);
  const std::size_t offset = required_size(view, "byteOffset");
  const std::size_t length = required_size(view, "byteLength");
  if (required_size(view, "buffer") != 0 || view.contains("byteStride")) {
    throw ModelFault("a bufferView is not packed into the file's own buffer");
  }
  if (offset > glb.binary.size() || length > glb.binary.size() - offset) {
    throw ModelFault("a bufferView reaches beyond the file");
  }
  return glb.binary.subspan(offset, length);
}

// An accessor as `write_model` writes them: one per bufferView, packed.
template <typename T>
std::vector<T> read_accessor(const Glb& glb, const json& owner, const char* name,
                             unsigned component_type, const char* type,
                             std::size_t elements_per_value) {
  const json& accessor = element(glb.document, "accessors", required_size(owner, name));
  if (required_size(accessor, "componentType") != component_type ||
      required_string(accessor, "type") != type || accessor.contains("byteOffset") ||
      accessor.contains("sparse")) {
    throw ModelFault(std::string("its ") + name + " are stored in a form sheen does not write");
  }
  const std::size_t count = required_size(accessor, "count");
  const auto bytes = view_bytes(glb, required_size(accessor, "bufferView"));
  if (count % elements_per_value != 0 || bytes.size() % sizeof(T) != 0 ||
      bytes.size() / sizeof(T) != count / elements_per_value || count == 0) {
    throw ModelFault(std::string("the size of its ") + name + " does not fit their count");
  }
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
  return values;
}

void check_mesh(const core::Mesh& mesh) {
  if (mesh.normals.size() != mesh.positions.size()) {
    throw ModelFault("it has not as many normals as positions");
  }
  for (const Eigen::Vector3f& position : mesh.positions) {
    if (!position.allFinite()) throw ModelFault("a position is not finite");
  }
  for (const Eigen::Vector3f& normal : mesh.normals) {
    if (!(std::abs(normal.norm() - 1.0f) < 1e-3f)) throw ModelFault("a normal has not unit length");
  }
  for (const auto& triangle : mesh.triangles) {
    if (triangle.maxCoeff() >= mesh.positions.size()) {
      throw ModelFault("a triangle names a vertex that does not exist");
    }
  }
}

const json& primitive_of(const Glb& glb) {
  return element(element(glb.document, "meshes", 0), "primitives", 0);
}

core::Mesh read_mesh_part(const Glb& glb) {
  const json& primitive = primitive_of(glb);
  const json& attributes = required(primitive, "attributes");
  using Triangle = decltype(core::Mesh::triangles)::value_type;
  core::Mesh mesh;
  mesh.positions = read_accessor<Eigen::Vector3f>(glb, attributes, "POSITION", kFloat, "VEC3", 1);
  mesh.normals = read_accessor<Eigen::Vector3f>(glb, attributes, "NORMAL", kFloat, "VEC3", 1);
  mesh.triangles = read_accessor<Triangle>(glb, primitive, "indices", kUnsignedInt, "SCALAR", 3);
  check_mesh(mesh);
  return mesh;
}

/// Vertices that repeat earlier ones, because the texture has a seam there: which ones they repeat.
std::vector<std::uint32_t> read_copies(const Glb& glb, const json& extension,
                                       const core::Mesh& mesh) {
  if (!extension.contains("copies")) return {};
  const auto bytes = view_bytes(glb, required_size(extension, "copies"));
  std::vector<std::uint32_t> copies(bytes.size() / sizeof(std::uint32_t));
  if (copies.size() >= mesh.positions.size() || bytes.size() % sizeof(std::uint32_t) != 0) {
    throw ModelFault("it does not have as many vertices as it says it repeats");
  }
  std::memcpy(copies.data(), bytes.data(), bytes.size());
  const std::size_t own = mesh.positions.size() - copies.size();
  for (std::size_t i = 0; i < copies.size(); ++i) {
    if (copies[i] >= own || mesh.positions[copies[i]] != mesh.positions[own + i] ||
        mesh.normals[copies[i]] != mesh.normals[own + i]) {
      throw ModelFault("a vertex does not repeat the one that it should");
    }
  }
  return copies;
}

/// Takes the vertices that repeat others out again.
void join_vertices(const std::vector<std::uint32_t>& copies, core::Mesh& mesh) {
  const std::size_t own = mesh.positions.size() - copies.size();
  mesh.positions.resize(own);
  mesh.normals.resize(own);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& vertex : triangle) {
      if (vertex >= own) vertex = copies[vertex - own];
    }
  }
}

/// The texture, if there is one; `mesh` becomes the one that was written.
std::optional<SurfaceTexture> read_texture(const Glb& glb, const json& extension,
                                           core::Mesh& mesh) {
  if (!extension.contains("image")) return std::nullopt;
  const json& attributes = required(primitive_of(glb), "attributes");
  const auto places =
      read_accessor<core::AtlasPoint>(glb, attributes, "TEXCOORD_0", kUnsignedShort, "VEC2", 1);
  if (places.size() != mesh.positions.size()) {
    throw ModelFault("it has not as many places on its texture as positions");
  }
  const json& image = element(glb.document, "images", required_size(extension, "image"));
  SurfaceTexture texture = decode_texture(view_bytes(glb, required_size(image, "bufferView")),
                                          core::corners_of(places, mesh.triangles));
  join_vertices(read_copies(glb, extension, mesh), mesh);
  return texture;
}

void check_conventions(const json& extension) {
  if (required_size(extension, "version") != kExtensionVersion) {
    throw ModelFault("its version of " + std::string(kExtension) + " is not 1");
  }
  if (required_string(extension, "directionMap") != kDirectionMap ||
      required_string(extension, "tangentFrame") != kTangentFrame ||
      required_string(extension, "colorSpace") != kColourSpace) {
    throw ModelFault("its direction map, tangent frame or colour space is unknown");
  }
}

Eigen::Vector3d read_offset(const json& extension) {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  if (!extension.is_object() || !extension.contains("offset")) return offset;
  const json& numbers = extension["offset"];
  if (!numbers.is_array() || numbers.size() != 3) throw ModelFault("its \"offset\" is no position");
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const json& number = numbers[static_cast<std::size_t>(axis)];
    offset[axis] = number.is_number() ? number.get<double>() : std::nan("");
    if (!std::isfinite(offset[axis])) throw ModelFault("its \"offset\" is no position");
  }
  return offset;
}

/// From where every patch was looked at, if the file says.
SeenDirections read_seen(const Glb& glb, const json& extension, std::size_t patch_count) {
  if (!extension.contains("seen")) return {};
  const auto bytes = view_bytes(glb, required_size(extension, "seen"));
  SeenDirections seen(patch_count);
  if (bytes.size() != patch_count * sizeof(seen[0])) {
    throw ModelFault("it has not one set of seen directions per vertex");
  }
  std::memcpy(seen.data(), bytes.data(), bytes.size());
  return seen;
}

ModelPart read_part(const Glb& glb, const json& extension) {
  ModelPart part;
  part.parameters = required(extension, "parameters");
  const json& arrays = required(extension, "arrays");
  if (!arrays.is_object()) throw ModelFault("its \"arrays\" is not an object");
  for (const auto& [name, view] : arrays.items()) {
    part.arrays[name] = view_bytes(glb, required_size(arrays, name.c_str()));
  }
  if (extension.contains("observed")) {
    part.observed = view_bytes(glb, required_size(extension, "observed"));
  }
  return part;
}

std::unique_ptr<const LightField> decode_light_field(const json& extension, const ModelPart& part,
                                                     const core::Mesh& mesh) {
  const std::string name = required_string(extension, "representation");
  for (const Descriptor* descriptor : representations()) {
    if (descriptor->name == name) return descriptor->decode(part, mesh);
  }
  throw ModelFault("its representation \"" + name.substr(0, 40) + "\" is unknown");
}

Model parse_model(const std::string& file) {
  const Glb glb = parse_glb(file);
  // Not copied: a copy recurses as deep as a hostile file nests.
  const auto found = glb.document.find("extensions");
  if (found == glb.document.end() || !found->is_object() || !found->contains(kExtension)) {
    throw ModelFault(std::string("it does not hold the extension ") + kExtension);
  }
  if (!has_valid_checksum(file))
    throw ModelFault("its checksum does not fit: the file was altered");
  Model model;
  model.mesh = read_mesh_part(glb);
  const json& extension = required(*found, kExtension);
  model.mesh.offset = read_offset(extension);
  check_conventions(extension);
  const std::optional<SurfaceTexture> texture = read_texture(glb, extension, model.mesh);
  ModelPart part = read_part(glb, extension);
  if (texture) part.texture = &*texture;
  model.light_field = decode_light_field(extension, part, model.mesh);
  model.seen = read_seen(glb, extension, model.mesh.positions.size());
  return model;
}

}  // namespace

bool is_model(const std::filesystem::path& path) {
  // Length of the first chunk after twelve bytes of header; its kind before its bytes.
  std::ifstream file(path, std::ios::binary);
  std::array<std::uint8_t, 20> start{};
  if (!file.read(reinterpret_cast<char*>(start.data()), start.size())) return false;
  std::size_t length = 0;
  for (std::size_t i = 0; i < 4; ++i) length |= std::size_t{start[12 + i]} << (8 * i);
  std::error_code failure;
  const auto size = static_cast<std::size_t>(std::filesystem::file_size(path, failure));
  std::string text(std::min(length, failure ? 0 : size), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  return text.find(kExtension) != std::string::npos;
}

Model read_model(const std::filesystem::path& path) {
  try {
    return parse_model(read_bytes(path));
  } catch (const ModelFault& fault) {
    throw core::bad_input(path, std::string("no usable sheen model: ") + fault.what(),
                          "give a .glb file as sheen wrote it, or make it again with sheen replay");
  }
}

}  // namespace sheen::fitting
