// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace sheen::tests {

/// Builds binary glTF files piece by piece: one mesh of one primitive under one node.
class GlbBuilder {
 public:
  enum Component : unsigned {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126
  };

  GlbBuilder() {
    document = {{"asset", {{"version", "2.0"}}},
                {"scene", 0},
                {"scenes", {{{"nodes", {0}}}}},
                {"nodes", {{{"mesh", 0}}}},
                {"meshes", {{{"primitives", {nlohmann::json::object()}}}}},
                {"bufferViews", nlohmann::json::array()},
                {"accessors", nlohmann::json::array()}};
    primitive()["attributes"] = nlohmann::json::object();
  }

  nlohmann::json& primitive() { return document["meshes"][0]["primitives"][0]; }
  nlohmann::json& node() { return document["nodes"][0]; }

  void require(const std::string& extension) {
    document["extensionsUsed"].push_back(extension);
    document["extensionsRequired"].push_back(extension);
  }

  /// Index of a new buffer view over `bytes`.
  std::size_t add_view(const std::string& bytes, std::size_t stride = 0) {
    binary.append((4 - binary.size() % 4) % 4, '\0');
    nlohmann::json view = {
        {"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) view["byteStride"] = stride;
    binary += bytes;
    document["bufferViews"].push_back(view);
    return document["bufferViews"].size() - 1;
  }

  /// Index of a new accessor; `more` is merged into it.
  std::size_t add_accessor(nlohmann::json accessor) {
    document["accessors"].push_back(std::move(accessor));
    return document["accessors"].size() - 1;
  }

  std::size_t add_vectors(std::size_t view, Component component, std::size_t count,
                          bool is_normalised = false) {
    nlohmann::json accessor = {
        {"bufferView", view}, {"componentType", component}, {"count", count}, {"type", "VEC3"}};
    if (is_normalised) accessor["normalized"] = true;
    return add_accessor(accessor);
  }

  std::size_t add_indices(const std::vector<std::uint32_t>& indices) {
    std::string bytes;
    for (const std::uint32_t index : indices) append(bytes, index);
    return add_accessor({{"bufferView", add_view(bytes)},
                         {"componentType", uint32},
                         {"count", indices.size()},
                         {"type", "SCALAR"}});
  }

  template <typename T>
  static void append(std::string& bytes, const T& value) {
    const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    bytes.append(raw.data(), raw.size());
  }

  /// The file. Without `is_aligned` the chunks are as long as their content, as some exporters
  /// write them.
  [[nodiscard]] std::string bytes(bool is_aligned = true) const {
    nlohmann::json whole = document;
    whole["buffers"] = {{{"byteLength", binary.size()}}};
    std::string text = whole.dump();
    std::string data = binary;
    if (is_aligned) {
      text.append((4 - text.size() % 4) % 4, ' ');
      data.append((4 - data.size() % 4) % 4, '\0');
    } else if (text.size() % 4 == 0) {
      text += ' ';
    }
    std::string file = "glTF";
    append(file, std::uint32_t{2});
    append(file, static_cast<std::uint32_t>(28 + text.size() + data.size()));
    append(file, static_cast<std::uint32_t>(text.size()));
    file += "JSON" + text;
    append(file, static_cast<std::uint32_t>(data.size()));
    return file + std::string("BIN\0", 4) + data;
  }

  nlohmann::json document;
  std::string binary;
};

}  // namespace sheen::tests
