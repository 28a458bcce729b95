// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/confidence/confidence.h"
#include "fitting/light_field.h"

#include <cstddef>
#include <filesystem>
#include <memory>

namespace sheen::fitting {

/// A light field and the surface it lies on.
struct Model {
  core::Mesh mesh;
  std::unique_ptr<const LightField> light_field;
  SeenDirections seen = {};  ///< of every patch; empty where the file does not say
};

/// Bytes of a light field in a model file: those of its arrays and of its texture's image, without
/// mesh, places on the texture and names.
std::size_t byte_size(const LightField& light_field);

/// Writes a binary glTF 2.0 file with the extension SHEEN_surface_light_field (docs/formats.md,
/// "model"), beside its final name and then moved into place. Equal models give equal bytes. `seen`
/// has an entry per patch, or none.
void write_model(const std::filesystem::path& path, const core::Mesh& mesh,
                 const LightField& light_field, const SeenDirections& seen = {});

/// Whether a file names that extension where binary glTF files have their text: of a model that is
/// whole or broken, not of other programs' meshes.
bool is_model(const std::filesystem::path& path);

/// Reads it back, bit by bit what was written. Throws core::Error (bad_input) for truncated,
/// altered or foreign files.
Model read_model(const std::filesystem::path& path);

}  // namespace sheen::fitting
