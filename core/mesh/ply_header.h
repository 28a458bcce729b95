// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::core {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyScalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// A scalar, or a list when `count` names the type of its length.
struct PlyProperty {
  std::string name;
  PlyScalar type = PlyScalar::float32;
  std::optional<PlyScalar> count;
};

struct PlyElement {
  std::string name;
  std::size_t rows = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t size_bytes = 0;  ///< where the body begins
};

/// Parses the header at the start of `bytes`; `path` is for messages only. Row counts are checked
/// to fit into the file, so they may be reserved. Throws Error (bad_input).
PlyHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& path);

}  // namespace sheen::core
