// SPDX-License-Identifier: MIT
#include "core/mesh/glb_guard.h"

#include "core/diagnostics/error.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

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
}

}  // namespace sheen::core
