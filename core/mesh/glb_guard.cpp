// SPDX-License-Identifier: MIT
#include "core/mesh/glb_guard.h"

#include "core/diagnostics/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace sheen::core {
namespace {

using nlohmann::json;

Error broken(const std::filesystem::path& path, const std::string& fault) {
  return bad_input(path, fault, "it may be cut short; write it again");
}

/// The JSON chunk, which comes first.
std::string read_json_chunk(const std::filesystem::path& path, std::uint64_t file_size) {
  // magic, version, length; chunk length, chunk type
  std::array<std::uint32_t, 5> words{};
  std::array<char, sizeof(words)> raw{};
  std::ifstream file(path, std::ios::binary);
  file.read(raw.data(), raw.size());
  std::memcpy(words.data(), raw.data(), raw.size());
  constexpr std::uint32_t magic = 0x46546C67;      // "glTF"
  constexpr std::uint32_t json_type = 0x4E4F534A;  // "JSON"
  if (!file || words[0] != magic || words[1] != 2 || words[4] != json_type) {
    throw broken(path, "is not a binary glTF 2.0 file");
  }
  if (words[2] > file_size || words[3] > file_size - raw.size()) {
    throw broken(path, "is shorter than its header says");
  }
  std::string text(words[3], '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file) throw broken(path, "cannot be read");
  return text;
}

bool is_size_within(const json& object, const char* key, std::uint64_t limit) {
  const auto value = object.find(key);
  return value != object.end() && value->is_number_unsigned() &&
         value->get<std::uint64_t>() <= limit;
}

/// Whether `document[list]` is absent or an array whose objects state a size of at most `limit`.
bool states_sizes(const json& document, const char* list, const char* key, std::uint64_t limit) {
  const auto entries = document.find(list);
  if (entries == document.end()) return true;
  if (!entries->is_array()) return false;
  for (const json& entry : *entries) {
    if (!entry.is_object() || !is_size_within(entry, key, limit)) return false;
  }
  return true;
}

/// What stands under `key`, an empty array where nothing does. By reference: copies of JSON
/// recurse, and a file may nest it a million times.
const json& member(const json& object, const char* key) {
  static const json none = json::array();
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

/// Distinct indices below `end` under `key` of `object`; none where it is absent. No value for
/// anything else.
std::optional<std::vector<std::size_t>> distinct_indices(const json& object, const char* key,
                                                         std::size_t end) {
  const json& list = member(object, key);
  if (!object.is_object() || !list.is_array()) return std::nullopt;
  std::vector<std::size_t> indices;
  for (const json& entry : list) {
    if (!entry.is_number_unsigned() || entry.get<std::uint64_t>() >= end) return std::nullopt;
    indices.push_back(entry.get<std::size_t>());
  }
  std::vector<std::size_t> sorted = indices;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return std::nullopt;
  return indices;
}

/// Whether no node has two parents or lies deeper than a sane file nests them. assimp walks nodes
/// by recursion and once for every way that leads to them.
bool nodes_are_trees(const json& document) {
  constexpr int deepest = 256;
  const json& nodes = member(document, "nodes");
  if (!nodes.is_array()) return false;
  std::vector<std::vector<std::size_t>> children;
  std::vector<std::uint8_t> has_parent(nodes.size(), 0);
  for (const json& node : nodes) {
    const auto below = distinct_indices(node, "children", nodes.size());
    if (!below) return false;
    for (const std::size_t child : *below) {
      if (has_parent[child] != 0) return false;
      has_parent[child] = 1;
    }
    children.push_back(*below);
  }

  // Walk down level by level; what is never reached lies on a cycle.
  std::vector<std::size_t> level;
  for (std::size_t i = 0; i < children.size(); ++i) {
    if (has_parent[i] == 0) level.push_back(i);
  }
  std::size_t reached = 0;
  for (int depth = 0; !level.empty(); ++depth) {
    if (depth == deepest) return false;
    reached += level.size();
    std::vector<std::size_t> next;
    for (const std::size_t i : level) {
      next.insert(next.end(), children[i].begin(), children[i].end());
    }
    level = std::move(next);
  }
  return reached == children.size();
}

bool scenes_name_roots_once(const json& document) {
  const json& scenes = member(document, "scenes");
  const std::size_t nodes = member(document, "nodes").size();
  return scenes.is_array() && std::all_of(scenes.begin(), scenes.end(), [&](const json& scene) {
           return distinct_indices(scene, "nodes", nodes).has_value();
         });
}

/// Elements of the accessor that `index` names; none for an index that names none, which assimp
/// refuses itself.
std::uint64_t element_count(const json& accessors, const json& index) {
  if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= accessors.size()) return 0;
  return accessors[index.get<std::size_t>()]["count"].get<std::uint64_t>();
}

/// Elements that all primitives together ask for. Primitives may share accessors, so that a small
/// file can ask for any number.
std::uint64_t elements_of_primitives(const json& document) {
  const json& accessors = member(document, "accessors");
  std::uint64_t sum = 0;
  for (const json& mesh : member(document, "meshes")) {
    for (const json& primitive : member(mesh, "primitives")) {
      sum += element_count(accessors, member(primitive, "indices"));
      for (const json& attribute : member(primitive, "attributes")) {
        sum += element_count(accessors, attribute);
      }
    }
  }
  return sum;
}

}  // namespace

void check_glb(const std::filesystem::path& path) {
  std::error_code failure;
  const std::uint64_t file_size = std::filesystem::file_size(path, failure);
  constexpr std::uint64_t header_size = 20;
  if (failure || file_size < header_size) throw broken(path, "is not a binary glTF 2.0 file");
  const json document = json::parse(read_json_chunk(path, file_size), nullptr, false);
  if (!document.is_object()) throw broken(path, "holds JSON that cannot be parsed");
  if (!states_sizes(document, "buffers", "byteLength", file_size) ||
      !states_sizes(document, "bufferViews", "byteLength", file_size) ||
      !states_sizes(document, "accessors", "count", file_size)) {
    throw broken(path, "holds a buffer of missing or impossible size");
  }
  if (!nodes_are_trees(document) || !scenes_name_roots_once(document)) {
    throw bad_input(path, "has nodes that are no trees of at most 256 levels",
                    "write it again with every node under one parent");
  }
  // Every element takes a byte or more; a few primitives may well share their vertices.
  constexpr std::uint64_t most_sharing = 4;
  if (elements_of_primitives(document) > most_sharing * file_size) {
    throw bad_input(path, "has primitives that repeat the same data too often",
                    "join its primitives");
  }
}

}  // namespace sheen::core
