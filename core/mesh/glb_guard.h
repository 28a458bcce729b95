// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace sheen::core {

/// Checks what assimp takes on trust in a binary glTF 2.0 file: chunk sizes, that every buffer view
/// and accessor states a size that the file can hold, that nodes form trees of bounded depth and
/// that primitives do not repeat the same data without end. Without this an altered file makes
/// assimp allocate, read or recurse without end. Throws Error (bad_input).
void check_glb(const std::filesystem::path& path);

}  // namespace sheen::core
