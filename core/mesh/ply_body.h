// SPDX-License-Identifier: MIT
#pragma once

#include "core/diagnostics/error.h"
#include "core/mesh/ply_header.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace sheen::core {

/// Reads the numbers behind a PLY header one after the other, whatever the format; none is read
/// past the end. Throws Error (bad_input).
class PlyBody {
 public:
  /// `path` is for messages and must outlive this.
  PlyBody(std::string_view bytes, PlyFormat format, const std::filesystem::path& path)
      : rest_(bytes), format_(format), path_(path) {}

  double next(PlyScalar type);

  /// A vertex index: an integer in [0, end).
  std::size_t next_index(PlyScalar type, std::size_t end);

  /// Length of a list; every entry takes at least one byte.
  std::size_t next_length(PlyScalar type);

  void skip_list(const PlyProperty& property);
  void skip_row(const PlyElement& element);

  [[nodiscard]] Error broken(const std::string& fault) const {
    return bad_input(path_, fault, "write it again");
  }

 private:
  template <typename T>
  T next_binary();
  double next_word();
  std::size_t next_integer(PlyScalar type, std::size_t end, const char* fault);

  std::string_view rest_;
  PlyFormat format_;
  const std::filesystem::path& path_;
};

}  // namespace sheen::core
