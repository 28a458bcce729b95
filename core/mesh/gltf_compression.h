// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh_file.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::core {

/// Bytes of a buffer view that EXT_meshopt_compression holds packed. `extension` is its object,
/// `packed` the bytes that it names. Throws GltfFault.
std::vector<std::byte> unpack_meshopt(const nlohmann::json& extension,
                                      std::span<const std::byte> packed);

/// A primitive as KHR_draco_mesh_compression holds it.
struct DracoPrimitive {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3f> normals;  ///< empty, or one for every position
  std::vector<std::uint32_t> corners;    ///< three for every triangle
};

/// `normal_id` is negative where the primitive has no normals. Nothing larger than `most_vertices`
/// and `most_triangles` is decoded, so that altered bytes ask for no more memory than the file's
/// accessors promise. Throws GltfFault.
DracoPrimitive unpack_draco(std::span<const std::byte> packed, int position_id, int normal_id,
                            std::size_t most_vertices, std::size_t most_triangles);

}  // namespace sheen::core
