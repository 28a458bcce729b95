// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace sheen::exporters::viewer {

/// Tables of whole numbers as the page holds them: column by column, each predicted in whichever
/// way suits it best, bytes of equal weight together, all of it compressed by zlib
/// (docs/exports.md, "Web viewer").
class PackedArrays {
 public:
  /// A table row by row, `columns` >= 1; `bytes` (1, 2 or 4) per number, of which the lower ones
  /// are kept.
  void add(const std::string& name, std::span<const std::int32_t> rows, std::size_t columns,
           int bytes);

  /// What the page must know to take them apart: name, columns, rows, bytes, predictions.
  [[nodiscard]] const nlohmann::json& tables() const { return tables_; }
  [[nodiscard]] std::size_t unpacked_bytes() const { return planes_.size(); }
  /// A zlib stream. Equal tables give equal bytes.
  [[nodiscard]] std::string compressed() const;

 private:
  nlohmann::json tables_ = nlohmann::json::array();
  std::string planes_;
};

/// RFC 4648, section 4.
std::string base64(std::string_view bytes);

}  // namespace sheen::exporters::viewer
