// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace sheen::fitting {

/// The two chunks of a binary glTF 2.0 file.
struct Glb {
  nlohmann::json document;
  std::span<const std::byte> binary;  ///< points into the file's bytes
};

/// The whole file; sizes are padded to 4 bytes. Nothing when it would pass the format's limit of 4
/// GiB.
std::optional<std::string> glb_bytes(const nlohmann::json& document, const std::string& binary);

/// Takes a file apart. Throws ModelFault when header, chunk sizes or JSON are broken: the two
/// chunks must fill the file exactly.
Glb parse_glb(std::string_view file);

}  // namespace sheen::fitting
