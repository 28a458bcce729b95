// SPDX-License-Identifier: MIT
#include "fitting/model_file/glb.h"

#include "core/text/nesting.h"
#include "fitting/model_file/model_part.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

namespace sheen::fitting {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr std::uint32_t kMagic = 0x46546c67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004e4942;  // "BIN"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

void append_word(std::string& bytes, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  bytes.append(reinterpret_cast<const char*>(&word), sizeof(word));
}

void append_chunk(std::string& bytes, std::uint32_t kind, const std::string& content, char filler) {
  const std::size_t padded = (content.size() + 3) / 4 * 4;
  append_word(bytes, padded);
  append_word(bytes, kind);
  bytes += content;
  bytes.append(padded - content.size(), filler);
}

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  if (offset + sizeof(std::uint32_t) > bytes.size()) throw ModelFault("the file is truncated");
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof(word));
  return word;
}

// Content of the chunk at `offset`, which is moved behind it.
std::string_view take_chunk(std::string_view file, std::size_t& offset, std::uint32_t kind) {
  const std::size_t size = word_at(file, offset);
  if (word_at(file, offset + 4) != kind) throw ModelFault("its chunks are not JSON and BIN");
  offset += kChunkHeaderBytes;
  if (size > file.size() - offset) throw ModelFault("the file is truncated");
  const std::string_view content = file.substr(offset, size);
  offset += size;
  return content;
}

}  // namespace

std::optional<std::string> glb_bytes(const nlohmann::json& document, const std::string& binary) {
  const std::string text = document.dump();
  const std::size_t total = kHeaderBytes + 2 * kChunkHeaderBytes + (text.size() + 3) / 4 * 4 +
                            (binary.size() + 3) / 4 * 4;
  if (total > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  std::string bytes;
  bytes.reserve(total);
  append_word(bytes, kMagic);
  append_word(bytes, 2);
  append_word(bytes, total);
  append_chunk(bytes, kJsonChunk, text, ' ');
  append_chunk(bytes, kBinaryChunk, binary, '\0');
  return bytes;
}

Glb parse_glb(std::string_view file) {
  if (word_at(file, 0) != kMagic) throw ModelFault("it is not a binary glTF file");
  if (word_at(file, 4) != 2) throw ModelFault("it is not glTF version 2");
  if (word_at(file, 8) != file.size()) {
    throw ModelFault("it has " + std::to_string(file.size()) + " bytes but its header says " +
                     std::to_string(word_at(file, 8)));
  }
  std::size_t offset = kHeaderBytes;
  const std::string_view text = take_chunk(file, offset, kJsonChunk);
  const std::string_view binary = take_chunk(file, offset, kBinaryChunk);
  if (offset != file.size()) throw ModelFault("something follows its last chunk");
  if (core::json_depth(text) > core::kMostNesting) {
    throw ModelFault("its JSON chunk nests without end");
  }
  nlohmann::json document = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object()) throw ModelFault("its JSON chunk cannot be parsed");
  return {std::move(document), std::as_bytes(std::span(binary))};
}

}  // namespace sheen::fitting
