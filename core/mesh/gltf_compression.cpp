// SPDX-License-Identifier: MIT
#include "core/mesh/gltf_compression.h"

#include "core/mesh/gltf_container.h"

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <exception>
#include <string>

namespace sheen::core {
namespace {

using nlohmann::json;

constexpr std::size_t kMostRatio = 1024;  // a block of zeros packs 64 to one, constant columns more

[[noreturn]] void fail(const char* extension) {
  throw GltfFault(std::string("holds data of ") + extension + " that cannot be unpacked",
                  "export it without compression");
}

std::string text_at(const json& object, const char* key, const std::string& fallback) {
  const auto found = object.find(key);
  if (found == object.end()) return fallback;
  return found->is_string() ? found->get<std::string>() : std::string();
}

/// The library checks its arguments by assertions only.
void check_meshopt(const std::string& mode, const std::string& filter, std::size_t stride,
                   std::size_t count) {
  const bool is_vertices = mode == "ATTRIBUTES";
  const bool is_triangles = mode == "TRIANGLES";
  const bool is_sequence = mode == "INDICES";
  bool fits =
      is_vertices ? stride > 0 && stride <= 256 && stride % 4 == 0 : stride == 2 || stride == 4;
  fits = fits && (is_vertices || is_triangles || is_sequence);
  fits = fits && (!is_triangles || count % 3 == 0);
  if (filter == "OCTAHEDRAL") {
    fits = fits && is_vertices && (stride == 4 || stride == 8);
  } else if (filter == "QUATERNION") {
    fits = fits && is_vertices && stride == 8;
  } else {
    fits = fits && (filter == "NONE" || (filter == "EXPONENTIAL" && is_vertices));
  }
  if (!fits) {
    throw GltfFault("packs data by EXT_meshopt_compression in a way that is not known",
                    "export it without compression");
  }
}

/// The counts that a Draco mesh promises; the decoder believes them before it has the data.
class DracoHeader {
 public:
  explicit DracoHeader(std::span<const std::byte> bytes) : rest_(bytes) {
    constexpr std::string_view magic = "DRACO";
    for (const char letter : magic) {
      if (byte() != static_cast<std::uint8_t>(letter)) fail("KHR_draco_mesh_compression");
    }
    const unsigned major = byte(), minor = byte();
    const unsigned geometry = byte(), method = byte();
    const unsigned flags = byte() | static_cast<unsigned>(byte()) << 8U;
    constexpr unsigned has_metadata = 0x8000;
    // glTF allows version 2.2 of meshes only, and no metadata.
    if (major != 2 || minor != 2 || geometry != 1 || (flags & has_metadata) != 0) {
      fail("KHR_draco_mesh_compression");
    }
    if (method == 1) byte();  // edge breaker: how the mesh was walked
    vertices = number();
    triangles = number();
    // Without edge breaker the faces come first.
    if (method != 1) std::swap(vertices, triangles);
  }

  std::uint64_t vertices = 0, triangles = 0;

 private:
  std::uint8_t byte() {
    if (rest_.empty()) fail("KHR_draco_mesh_compression");
    const auto value = static_cast<std::uint8_t>(rest_.front());
    rest_ = rest_.subspan(1);
    return value;
  }

  std::uint64_t number() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
      const std::uint8_t part = byte();
      value |= std::uint64_t{part & 0x7fU} << shift;
      if (part < 0x80) return value;
    }
    fail("KHR_draco_mesh_compression");
  }

  std::span<const std::byte> rest_;
};

template <typename Vector>
std::vector<Vector> values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
  using Scalar = typename Vector::Scalar;
  std::vector<Vector> values;
  values.reserve(mesh.num_points());
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
    Vector value;
    if (!attribute.ConvertValue<Scalar, 3>(attribute.mapped_index(i), value.data())) {
      fail("KHR_draco_mesh_compression");
    }
    values.push_back(value);
  }
  return values;
}

std::unique_ptr<draco::Mesh> decode_draco(std::span<const std::byte> packed) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(packed.data()), packed.size());
  draco::Decoder decoder;
  try {
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (decoded.ok()) return std::move(decoded).value();
  } catch (const std::exception&) {
    // No memory for what altered bytes ask for.
  }
  fail("KHR_draco_mesh_compression");
}

}  // namespace

std::vector<std::byte> unpack_meshopt(const json& extension, std::span<const std::byte> packed) {
  const std::size_t count = gltf_size(extension, "count");
  const std::size_t stride = gltf_size(extension, "byteStride");
  const std::string mode = text_at(extension, "mode", "");
  const std::string filter = text_at(extension, "filter", "NONE");
  check_meshopt(mode, filter, stride, count);
  if (count > kMostRatio * packed.size() / stride) fail("EXT_meshopt_compression");
  std::vector<std::byte> bytes(count * stride);
  const auto* const source = reinterpret_cast<const unsigned char*>(packed.data());
  int status = 0;
  if (mode == "ATTRIBUTES") {
    status = meshopt_decodeVertexBuffer(bytes.data(), count, stride, source, packed.size());
  } else if (mode == "TRIANGLES") {
    status = meshopt_decodeIndexBuffer(bytes.data(), count, stride, source, packed.size());
  } else {
    status = meshopt_decodeIndexSequence(bytes.data(), count, stride, source, packed.size());
  }
  if (status != 0) fail("EXT_meshopt_compression");
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
  return bytes;
}

DracoPrimitive unpack_draco(std::span<const std::byte> packed, int position_id, int normal_id,
                            std::size_t most_vertices, std::size_t most_triangles) {
  const DracoHeader header(packed);
  if (header.vertices > most_vertices || header.triangles > most_triangles) {
    fail("KHR_draco_mesh_compression");
  }
  const auto mesh = decode_draco(packed);
  const draco::PointAttribute* const position =
      mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(position_id));
  if (position == nullptr || position->num_components() != 3 ||
      mesh->num_points() > most_vertices) {
    fail("KHR_draco_mesh_compression");
  }
  DracoPrimitive primitive;
  primitive.positions = values_of<Eigen::Vector3d>(*mesh, *position);
  if (normal_id >= 0) {
    const draco::PointAttribute* const normal =
        mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(normal_id));
    if (normal == nullptr || normal->num_components() != 3) fail("KHR_draco_mesh_compression");
    primitive.normals = values_of<Eigen::Vector3f>(*mesh, *normal);
  }
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
    for (const draco::PointIndex& corner : mesh->face(f)) {
      if (corner.value() >= mesh->num_points()) fail("KHR_draco_mesh_compression");
      primitive.corners.push_back(corner.value());
    }
  }
  return primitive;
}

}  // namespace sheen::core
