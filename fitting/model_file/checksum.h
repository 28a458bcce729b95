// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sheen::fitting {

/// A model file names the FNV-1a hash (64 bit) of all its bytes, its own 16 digits read as zeros.
/// Any single altered byte changes it, because each step of FNV-1a can be undone.
inline constexpr const char* kChecksumPlaceholder = "fnv1a64:0000000000000000";

/// Replaces the placeholder, which must occur, by the checksum.
void write_checksum(std::string& file);

/// Whether the file carries its own checksum.
bool has_valid_checksum(std::string file);

}  // namespace sheen::fitting
