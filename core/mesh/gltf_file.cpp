// SPDX-License-Identifier: MIT
#include "core/mesh/gltf_file.h"

#include "core/diagnostics/error.h"
#include "core/mesh/gltf_colours.h"
#include "core/mesh/gltf_compression.h"
#include "core/mesh/gltf_nodes.h"
#include "core/text/number.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>

namespace sheen::core {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 6> kRead = {
    "KHR_mesh_quantization",      "EXT_meshopt_compression", "KHR_meshopt_compression",
    "KHR_draco_mesh_compression", "EXT_mesh_gpu_instancing", "CESIUM_RTC"};
/// These say nothing about the shape.
constexpr std::array<std::string_view, 9> kHarmless = {
    "KHR_materials_",   "KHR_texture_",      "EXT_texture_",
    "KHR_lights_",      "KHR_xmp",           "ADOBE_materials",
    "MSFT_texture_dds", "EXT_mesh_features", "EXT_structural_metadata"};

void check_extensions(const json& document) {
  const json& required = gltf_member(document, "extensionsRequired");
  if (!required.is_array()) throw GltfFault("holds no list of extensions");
  for (const json& entry : required) {
    const std::string name = entry.is_string() ? entry.get<std::string>() : std::string("?");
    const bool is_known =
        std::find(kRead.begin(), kRead.end(), name) != kRead.end() ||
        std::any_of(kHarmless.begin(), kHarmless.end(),
                    [&name](std::string_view start) { return name.starts_with(start); });
    if (!is_known) {
      throw GltfFault("requires the extension " + quotable(name) + ", which is not read",
                      "export it without that extension");
    }
  }
}

/// One primitive in its own coordinates, its surface as triangles.
struct Primitive {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3f> normals;  ///< empty, or one for every position
  std::vector<Eigen::Vector3f> colours;  ///< the same
  std::vector<Eigen::Matrix<std::uint32_t, 3, 1>> triangles;
};

template <typename Scalar>
std::vector<Eigen::Matrix<Scalar, 3, 1>> vectors_of(const std::vector<double>& numbers) {
  std::vector<Eigen::Matrix<Scalar, 3, 1>> vectors;
  vectors.reserve(numbers.size() / 3);
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    vectors.push_back(Eigen::Vector3d(numbers[i], numbers[i + 1], numbers[i + 2]).cast<Scalar>());
  }
  return vectors;
}

class GltfReader {
 public:
  GltfReader(const std::filesystem::path& path, VertexColours colours)
      : gltf_(read_gltf_container(path)),
        accessors_(gltf_),
        colours_(gltf_, accessors_),
        reads_colours_(colours == VertexColours::read) {}

  MeshFile read() {
    check_extensions(gltf_.document);
    const auto instances = gltf_instances(gltf_, accessors_);
    bool has_skin = false;
    for (const GltfInstance& instance : instances) {
      has_skin |= instance.has_skin;
      for (const Primitive& primitive : primitives_of(instance.mesh)) {
        append(primitive, instance.scene_from_mesh);
      }
    }
    if (has_normals_) {
      mesh_.normals.resize(mesh_.positions.size(), Eigen::Vector3f::Zero());
    } else {
      mesh_.normals.clear();
    }
    if (!mesh_.colours.empty()) {
      mesh_.colours.resize(mesh_.positions.size(), Eigen::Vector3f::Ones());
    }
    add_notes(has_skin);
    return std::move(mesh_);
  }

 private:
  const std::vector<Primitive>& primitives_of(std::size_t index) {
    const auto known = meshes_.find(index);
    if (known != meshes_.end()) return known->second;
    const json& list = gltf_member(gltf_entry(gltf_.document, "meshes", index), "primitives");
    if (!list.is_array()) throw GltfFault("has a mesh without a list of primitives");
    std::vector<Primitive> primitives;
    for (const json& object : list) {
      if (!object.is_object()) throw GltfFault("has a primitive of no form");
      has_targets_ |= object.contains("targets");
      auto primitive = read_primitive(object);
      if (!primitive) continue;
      if (reads_colours_) primitive->colours = colours_.of(object, primitive->positions.size());
      primitives.push_back(std::move(*primitive));
    }
    return meshes_.emplace(index, std::move(primitives)).first->second;
  }

  /// Nothing for points and lines.
  std::optional<Primitive> read_primitive(const json& object) {
    const std::size_t mode = gltf_size(object, "mode", 4);
    if (mode < 4) {
      ++without_surface_;
      return std::nullopt;
    }
    const json& attributes = gltf_member(object, "attributes");
    if (!attributes.is_object() || !attributes.contains("POSITION")) {
      throw GltfFault("has a primitive without positions");
    }
    const std::size_t position = gltf_size(attributes, "POSITION");
    if (accessors_.count(position) > kMostVertices) refuse_size();
    if (const json* draco = gltf_extension(object, "KHR_draco_mesh_compression")) {
      return read_draco(object, *draco, position);
    }
    Primitive primitive;
    primitive.positions = vectors_of<double>(accessors_.numbers(position, 3));
    if (attributes.contains("NORMAL")) {
      primitive.normals = vectors_of<float>(accessors_.numbers(gltf_size(attributes, "NORMAL"), 3));
    }
    std::vector<std::uint32_t> corners;
    if (object.contains("indices")) {
      const std::size_t indices = gltf_size(object, "indices");
      if (accessors_.count(indices) > 3 * kMostTriangles) refuse_size();
      corners = accessors_.indices(indices);
    } else {
      corners.resize(primitive.positions.size());
      std::iota(corners.begin(), corners.end(), 0U);
    }
    build(corners, mode, primitive);
    return primitive;
  }

  Primitive read_draco(const json& object, const json& draco, std::size_t position) {
    const json& ids = gltf_member(draco, "attributes");
    if (!ids.is_object()) throw GltfFault("has a compressed primitive of no form");
    const std::size_t corners = object.contains("indices")
                                    ? std::min(accessors_.count(gltf_size(object, "indices")),
                                               std::size_t{3} * kMostTriangles)
                                    : 3 * kMostTriangles;
    static constexpr std::size_t most_id = 1U << 20U;
    const auto id = [&ids](const char* name) {
      return static_cast<int>(std::min(gltf_size(ids, name), most_id));
    };
    DracoPrimitive unpacked = unpack_draco(
        accessors_.view(gltf_size(draco, "bufferView")).bytes, id("POSITION"),
        ids.contains("NORMAL") ? id("NORMAL") : -1, accessors_.count(position), corners / 3);
    Primitive primitive{std::move(unpacked.positions), std::move(unpacked.normals), {}, {}};
    build(unpacked.corners, 4, primitive);
    return primitive;
  }

  /// Triangles (mode 4), a strip (5) or a fan (6).
  static void build(const std::vector<std::uint32_t>& corners, std::size_t mode,
                    Primitive& primitive) {
    if (mode > 6) throw GltfFault("has a primitive of a mode that glTF does not have");
    if (!primitive.normals.empty() && primitive.normals.size() != primitive.positions.size()) {
      throw GltfFault("has not as many normals as positions");
    }
    const auto add = [&primitive](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (std::max({a, b, c}) >= primitive.positions.size()) {
        throw GltfFault("has a face with a corner that does not exist");
      }
      primitive.triangles.emplace_back(a, b, c);
    };
    for (std::size_t i = 2; i < corners.size(); i += mode == 4 ? 3 : 1) {
      if (mode == 4) add(corners[i - 2], corners[i - 1], corners[i]);
      // Every second triangle of a strip runs the other way round.
      if (mode == 5 && i % 2 == 0) add(corners[i - 2], corners[i - 1], corners[i]);
      if (mode == 5 && i % 2 == 1) add(corners[i - 1], corners[i - 2], corners[i]);
      if (mode == 6) add(corners[0], corners[i - 1], corners[i]);
    }
  }

  void append(const Primitive& primitive, const Eigen::Affine3d& scene_from_mesh) {
    if (mesh_.positions.size() + primitive.positions.size() > kMostVertices ||
        mesh_.triangles.size() + primitive.triangles.size() > kMostTriangles) {
      refuse_size();
    }
    const auto base = static_cast<std::uint32_t>(mesh_.positions.size());
    const Eigen::Matrix3d linear = scene_from_mesh.linear();
    const double determinant = linear.determinant();
    for (const Eigen::Vector3d& position : primitive.positions) {
      mesh_.positions.push_back(scene_from_mesh * position);
    }
    if (!primitive.normals.empty()) {
      has_normals_ = true;
      mesh_.normals.resize(base, Eigen::Vector3f::Zero());
      // Without an inverse the normals are computed anew later: this gives NaN.
      const Eigen::Matrix3d turn = linear.inverse().transpose();
      const bool is_identity = linear == Eigen::Matrix3d::Identity();
      for (const Eigen::Vector3f& normal : primitive.normals) {
        mesh_.normals.push_back(
            is_identity
                ? normal
                : Eigen::Vector3f((turn * normal.cast<double>()).normalized().cast<float>()));
      }
    }
    // White is what glTF's parts are that say nothing.
    if (!primitive.colours.empty()) {
      mesh_.colours.resize(base, Eigen::Vector3f::Ones());
      mesh_.colours.insert(mesh_.colours.end(), primitive.colours.begin(), primitive.colours.end());
    }
    for (const auto& triangle : primitive.triangles) {
      const bool mirrors = determinant < 0;
      mesh_.triangles.emplace_back(base + triangle[0], base + triangle[mirrors ? 2 : 1],
                                   base + triangle[mirrors ? 1 : 2]);
    }
  }

  void add_notes(bool has_skin) {
    for (const std::string& note : colours_.notes()) mesh_.notes.push_back(note);
    if (has_skin) {
      mesh_.notes.emplace_back(
          "has a skin, which is passed over: the mesh stands as it was modelled");
    }
    if (has_targets_) {
      mesh_.notes.emplace_back(
          "has morph targets, which are passed over: the basic shape is taken");
    }
    if (without_surface_ > 0 && !mesh_.triangles.empty()) {
      mesh_.notes.emplace_back("has points or lines, which are passed over");
    }
  }

  [[noreturn]] static void refuse_size() {
    throw GltfFault("has more than 20 million vertices or 40 million triangles", "simplify it");
  }

  GltfContainer gltf_;
  GltfAccessors accessors_;
  GltfColours colours_;
  bool reads_colours_;
  std::map<std::size_t, std::vector<Primitive>> meshes_;
  MeshFile mesh_;
  bool has_normals_ = false;
  bool has_targets_ = false;
  int without_surface_ = 0;
};

}  // namespace

MeshFile read_glb(const std::filesystem::path& path, VertexColours colours) {
  try {
    return GltfReader(path, colours).read();
  } catch (const GltfFault& fault) {
    throw bad_input(path, fault.what(), fault.remedy());
  }
}

}  // namespace sheen::core
