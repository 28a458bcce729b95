// SPDX-License-Identifier: MIT
#include "core/mesh/gltf_nodes.h"

#include "core/mesh/mesh_file.h"

#include <algorithm>
#include <cstdint>

namespace sheen::core {
namespace {

using nlohmann::json;

constexpr std::size_t kDeepest = 256;  // levels: no sane file nests more

[[noreturn]] void refuse_nodes() {
  throw GltfFault("has nodes that are no trees of at most 256 levels",
                  "write it again with every node under one parent");
}

/// Indices of nodes under `key` of `object`; none where it is absent.
std::vector<std::size_t> node_list(const json& object, const char* key, std::size_t nodes) {
  const json& list = gltf_member(object, key);
  if (!object.is_object() || !list.is_array()) refuse_nodes();
  std::vector<std::size_t> indices;
  for (const json& entry : list) {
    if (!entry.is_number_unsigned() || entry.get<std::uint64_t>() >= nodes) refuse_nodes();
    indices.push_back(entry.get<std::size_t>());
  }
  return indices;
}

/// Children of every node; every node has one parent at most.
struct Forest {
  std::vector<std::vector<std::size_t>> children;
  std::vector<std::uint8_t> has_parent;
};

Forest read_forest(const json& document) {
  const json& nodes = gltf_member(document, "nodes");
  if (!nodes.is_array()) refuse_nodes();
  Forest forest;
  forest.has_parent.assign(nodes.size(), 0);
  for (const json& node : nodes) {
    forest.children.push_back(node_list(node, "children", nodes.size()));
    for (const std::size_t child : forest.children.back()) {
      if (forest.has_parent[child]++ != 0) refuse_nodes();
    }
  }
  return forest;
}

/// Throws unless every node is reached from a root within kDeepest levels: what is never reached
/// lies on a cycle.
void check_depth(const Forest& forest) {
  std::vector<std::size_t> level;
  for (std::size_t i = 0; i < forest.children.size(); ++i) {
    if (forest.has_parent[i] == 0) level.push_back(i);
  }
  std::size_t reached = 0;
  for (std::size_t depth = 0; !level.empty(); ++depth) {
    if (depth == kDeepest) refuse_nodes();
    reached += level.size();
    std::vector<std::size_t> next;
    for (const std::size_t i : level) {
      next.insert(next.end(), forest.children[i].begin(), forest.children[i].end());
    }
    level = std::move(next);
  }
  if (reached != forest.children.size()) refuse_nodes();
}

/// The nodes that a viewer starts from.
std::vector<std::size_t> roots_of(const json& document, const Forest& forest) {
  const json& scenes = gltf_member(document, "scenes");
  const std::size_t nodes = forest.children.size();
  if (!scenes.is_array()) refuse_nodes();
  std::vector<std::size_t> roots;
  if (scenes.empty()) {
    for (std::size_t i = 0; i < nodes; ++i) {
      if (forest.has_parent[i] == 0) roots.push_back(i);
    }
    return roots;
  }
  roots =
      node_list(gltf_entry(document, "scenes", gltf_size(document, "scene", 0)), "nodes", nodes);
  std::vector<std::uint8_t> is_named(nodes, 0);
  for (const std::size_t root : roots) {
    if (is_named[root]++ != 0) refuse_nodes();
  }
  return roots;
}

Eigen::Affine3d composed(const Eigen::Vector3d& translation, const Eigen::Vector4d& xyzw,
                         const Eigen::Vector3d& scale) {
  const double length = xyzw.norm();
  if (!(length > 0.5 && length < 2)) throw GltfFault("has a rotation that is no unit quaternion");
  const Eigen::Quaterniond rotation(xyzw.w(), xyzw.x(), xyzw.y(), xyzw.z());
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.linear() = rotation.normalized().toRotationMatrix() * scale.asDiagonal();
  transform.translation() = translation;
  return transform;
}

Eigen::Affine3d transform_of(const json& node) {
  if (const auto matrix = gltf_numbers(node, "matrix", 16)) {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    transform.matrix().topRows<3>() =
        Eigen::Map<const Eigen::Matrix4d>(matrix->data()).topRows<3>();  // by columns, as stored
    return transform;
  }
  Eigen::Vector3d translation = Eigen::Vector3d::Zero(), scale = Eigen::Vector3d::Ones();
  Eigen::Vector4d rotation(0, 0, 0, 1);
  if (const auto t = gltf_numbers(node, "translation", 3)) {
    translation = Eigen::Map<const Eigen::Vector3d>(t->data());
  }
  if (const auto r = gltf_numbers(node, "rotation", 4)) {
    rotation = Eigen::Map<const Eigen::Vector4d>(r->data());
  }
  if (const auto s = gltf_numbers(node, "scale", 3)) {
    scale = Eigen::Map<const Eigen::Vector3d>(s->data());
  }
  return composed(translation, rotation, scale);
}

/// Where the node's mesh stands in the node: once, or as often as EXT_mesh_gpu_instancing says.
std::vector<Eigen::Affine3d> copies_of(const json& node, GltfAccessors& accessors) {
  const json* instancing = gltf_extension(node, "EXT_mesh_gpu_instancing");
  if (instancing == nullptr) return {Eigen::Affine3d::Identity()};
  const json& attributes = gltf_member(*instancing, "attributes");
  const auto values = [&](const char* name, std::size_t components) {
    return attributes.is_object() && attributes.contains(name)
               ? accessors.numbers(gltf_size(attributes, name), components)
               : std::vector<double>();
  };
  const std::vector<double> t = values("TRANSLATION", 3), r = values("ROTATION", 4),
                            s = values("SCALE", 3);
  const std::size_t count = std::max({t.size() / 3, r.size() / 4, s.size() / 3});
  if ((!t.empty() && t.size() != 3 * count) || (!r.empty() && r.size() != 4 * count) ||
      (!s.empty() && s.size() != 3 * count)) {
    throw GltfFault("has instances that do not fit each other");
  }
  std::vector<Eigen::Affine3d> copies;
  for (std::size_t i = 0; i < count; ++i) {
    const auto vector3 = [i](const std::vector<double>& from, double fallback) {
      return from.empty() ? Eigen::Vector3d(Eigen::Vector3d::Constant(fallback))
                          : Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(from.data() + 3 * i));
    };
    const Eigen::Vector4d rotation =
        r.empty() ? Eigen::Vector4d(0, 0, 0, 1)
                  : Eigen::Vector4d(Eigen::Map<const Eigen::Vector4d>(r.data() + 4 * i));
    copies.push_back(composed(vector3(t, 0), rotation, vector3(s, 1)));
  }
  return copies;
}

}  // namespace

std::vector<GltfInstance> gltf_instances(const GltfContainer& gltf, GltfAccessors& accessors) {
  const Forest forest = read_forest(gltf.document);
  check_depth(forest);
  struct Visit {
    std::size_t node;
    Eigen::Affine3d scene_from_parent;
  };
  Eigen::Affine3d base = Eigen::Affine3d::Identity();
  if (const json* centre = gltf_extension(gltf.document, "CESIUM_RTC")) {
    if (const auto c = gltf_numbers(*centre, "center", 3)) {
      base.translation() = Eigen::Map<const Eigen::Vector3d>(c->data());
    }
  }
  std::vector<Visit> open;
  const std::vector<std::size_t> roots = roots_of(gltf.document, forest);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({*root, base});
  std::vector<GltfInstance> instances;
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const json& node = gltf_entry(gltf.document, "nodes", visit.node);
    const Eigen::Affine3d scene_from_node = visit.scene_from_parent * transform_of(node);
    if (node.contains("mesh")) {
      for (const Eigen::Affine3d& node_from_mesh : copies_of(node, accessors)) {
        instances.push_back(
            {gltf_size(node, "mesh"), scene_from_node * node_from_mesh, node.contains("skin")});
      }
      if (instances.size() > kMostTriangles)
        throw GltfFault("has too many instances", "simplify it");
    }
    const auto& children = forest.children[visit.node];
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      open.push_back({*child, scene_from_node});
    }
  }
  return instances;
}

}  // namespace sheen::core
