// SPDX-License-Identifier: MIT
#include "core/mesh/gltf_container.h"

#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/text/nesting.h"

#include <array>
#include <cmath>
#include <cstring>

namespace sheen::core {
namespace {

using nlohmann::json;

constexpr std::uint32_t kMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJson = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinary = 0x004E4942;  // "BIN\0"
constexpr std::size_t kHeader = 12, kChunkHeader = 8;

std::uint32_t word_at(const std::string& bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof(word));
  return word;
}

/// A chunk of `type` that begins at `offset` and lies within the file.
std::optional<std::string_view> chunk_at(const std::string& file, std::size_t offset,
                                         std::uint32_t type) {
  if (offset > file.size() || file.size() - offset < kChunkHeader) return std::nullopt;
  const std::size_t length = word_at(file, offset);
  if (word_at(file, offset + 4) != type) return std::nullopt;
  if (length > file.size() - offset - kChunkHeader)
    throw GltfFault("is shorter than its header says");
  return std::string_view(file).substr(offset + kChunkHeader, length);
}

/// The binary chunk, which begins where the JSON ends: exactly there, or at the next multiple of 4.
std::span<const std::byte> binary_chunk(const std::string& file, std::size_t json_end) {
  for (const std::size_t offset : {json_end, (json_end + 3) / 4 * 4}) {
    if (const auto chunk = chunk_at(file, offset, kBinary)) return std::as_bytes(std::span(*chunk));
  }
  return {};
}

std::vector<std::byte> decoded_base64(std::string_view text) {
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    int value = -1;
    if (c >= 'A' && c <= 'Z') value = c - 'A';
    if (c >= 'a' && c <= 'z') value = c - 'a' + 26;
    if (c >= '0' && c <= '9') value = c - '0' + 52;
    if (c == '+' || c == '-') value = 62;
    if (c == '/' || c == '_') value = 63;
    if (c == '=') break;
    if (value < 0) throw GltfFault("holds a data address that is no base64");
    bits = bits << 6U | static_cast<std::uint32_t>(value);
    if ((count += 6) >= 8) {
      count -= 8;
      bytes.push_back(static_cast<std::byte>(bits >> static_cast<unsigned>(count) & 0xffU));
    }
  }
  return bytes;
}

void find_buffers(GltfContainer& gltf, std::span<const std::byte> binary) {
  const json& buffers = gltf_member(gltf.document, "buffers");
  if (!buffers.is_array()) throw GltfFault("holds no list of buffers");
  gltf.inline_buffers.resize(buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const json& buffer = gltf_entry(gltf.document, "buffers", i);
    const auto uri = buffer.find("uri");
    if (uri == buffer.end()) {
      gltf.buffers.push_back(i == 0 ? binary : std::span<const std::byte>());
      continue;
    }
    if (!uri->is_string()) throw GltfFault("holds a buffer whose address is no text");
    const std::string& text = uri->get_ref<const std::string&>();
    const std::size_t comma = text.find(";base64,");
    if (!text.starts_with("data:") || comma == std::string::npos) {
      throw GltfFault("keeps its data in another file", "pack everything into one .glb file");
    }
    gltf.inline_buffers[i] = decoded_base64(std::string_view(text).substr(comma + 8));
    gltf.buffers.push_back(gltf.inline_buffers[i]);
  }
}

}  // namespace

const json& gltf_member(const json& object, const char* key) {
  static const json none = json::array();
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

const json& gltf_entry(const json& document, const char* list, std::size_t index) {
  const json& entries = gltf_member(document, list);
  if (!entries.is_array() || index >= entries.size() || !entries[index].is_object()) {
    throw GltfFault(std::string("names one of its ") + list + " that does not exist");
  }
  return entries[index];
}

std::size_t gltf_size(const json& object, const char* key, std::optional<std::size_t> fallback) {
  constexpr double most = 1e15;  // far above any file's size, far below where sums overflow
  const auto found = object.find(key);
  if (found == object.end() && fallback) return *fallback;
  // Some exporters write 3.0 for 3.
  const double value = found != object.end() && found->is_number() ? found->get<double>() : -1;
  if (!(value >= 0 && value <= most) || value != std::floor(value)) {
    throw GltfFault(std::string("holds a ") + key + " that is missing or no whole number");
  }
  return static_cast<std::size_t>(value);
}

std::optional<std::vector<double>> gltf_numbers(const json& object, const char* key,
                                                std::size_t count) {
  const auto found = object.find(key);
  if (found == object.end()) return std::nullopt;
  std::vector<double> numbers;
  if (found->is_array() && found->size() == count) {
    for (const json& entry : *found) {
      if (entry.is_number()) numbers.push_back(entry.get<double>());
      if (!entry.is_number() || !std::isfinite(numbers.back())) numbers.clear();
    }
  }
  if (numbers.size() != count) {
    throw GltfFault(std::string("holds a ") + key + " that is no list of " + std::to_string(count) +
                    " numbers");
  }
  return numbers;
}

const json* gltf_extension(const json& object, const char* name) {
  const json& extensions = gltf_member(object, "extensions");
  if (!extensions.is_object()) return nullptr;
  const auto found = extensions.find(name);
  return found != extensions.end() && found->is_object() ? &*found : nullptr;
}

GltfContainer read_gltf_container(const std::filesystem::path& path) {
  GltfContainer gltf;
  gltf.file = read_file(path);
  if (gltf.file.size() < kHeader + kChunkHeader || word_at(gltf.file, 0) != kMagic) {
    throw GltfFault("is not a binary glTF 2.0 file");
  }
  if (word_at(gltf.file, 4) != 2) {
    throw GltfFault("is glTF of version " + std::to_string(word_at(gltf.file, 4)) + ", not 2",
                    "export it as glTF 2.0");
  }
  if (word_at(gltf.file, 8) > gltf.file.size()) throw GltfFault("is shorter than its header says");
  const auto text = chunk_at(gltf.file, kHeader, kJson);
  if (!text) throw GltfFault("is not a binary glTF 2.0 file");
  if (json_depth(*text) > kMostNesting) throw GltfFault("holds JSON that nests without end");
  gltf.document = json::parse(*text, nullptr, false);
  if (!gltf.document.is_object()) throw GltfFault("holds JSON that cannot be parsed");
  find_buffers(gltf, binary_chunk(gltf.file, kHeader + kChunkHeader + text->size()));
  return gltf;
}

}  // namespace sheen::core
