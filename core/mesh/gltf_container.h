// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace sheen::core {

/// What is wrong with a glTF file and what to do, without its name: `read_glb` adds it.
class GltfFault : public std::runtime_error {
 public:
  explicit GltfFault(const std::string& fault,
                     std::string remedy = "it may be cut short; write it again")
      : std::runtime_error(fault), remedy_(std::move(remedy)) {}

  [[nodiscard]] const std::string& remedy() const { return remedy_; }

 private:
  std::string remedy_;
};

/// A binary glTF 2.0 file taken apart. Chunks may be unaligned, as some exporters write them.
struct GltfContainer {
  std::string file;                                    ///< all its bytes
  nlohmann::json document;                             ///< of the JSON chunk, an object
  std::vector<std::vector<std::byte>> inline_buffers;  ///< of data: addresses, by buffer
  std::vector<std::span<const std::byte>> buffers;     ///< empty where a buffer has no data
};

/// Throws GltfFault, or Error (bad_input) when the file cannot be read.
GltfContainer read_gltf_container(const std::filesystem::path& path);

/// What stands under `key`, an empty array where nothing does. By reference: copies of JSON
/// recurse, and a file may nest it a million times.
const nlohmann::json& gltf_member(const nlohmann::json& object, const char* key);

/// Entry `index` of the document's list, an object. Throws GltfFault.
const nlohmann::json& gltf_entry(const nlohmann::json& document, const char* list,
                                 std::size_t index);

/// The whole number from 0 under `key`, or `fallback` where the key is missing. Throws GltfFault.
std::size_t gltf_size(const nlohmann::json& object, const char* key,
                      std::optional<std::size_t> fallback = std::nullopt);

/// The `count` finite numbers under `key`; nothing where the key is missing. Throws GltfFault.
std::optional<std::vector<double>> gltf_numbers(const nlohmann::json& object, const char* key,
                                                std::size_t count);

/// The extension `name` of an object; null where it has none.
const nlohmann::json* gltf_extension(const nlohmann::json& object, const char* name);

}  // namespace sheen::core
