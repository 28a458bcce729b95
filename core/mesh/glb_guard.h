// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace sheen::core {

/// Checks what assimp takes on trust in a binary glTF 2.0 file: chunk sizes, and that every buffer
/// view and accessor states a size that the file can hold. Without this an altered file makes
/// assimp allocate and read without end. Throws Error (bad_input).
void check_glb(const std::filesystem::path& path);

}  // namespace sheen::core
