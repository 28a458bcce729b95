// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/mesh/ply_file.h"  // write_ply

#include <filesystem>
#include <string>
#include <vector>

namespace sheen::core {

/// Reads PLY, OBJ or GLB; transforms of nodes are applied, several meshes become one.
/// Polygons are cut into triangles, degenerate triangles are dropped. PLY and glTF: vertices keep
/// number and order of the file, also those that no triangle uses (which move to one that is used)
/// and those that share a position (hard edges), so that patch indices mean vertex indices. OBJ:
/// corners that share a position and a normal become one vertex, in order of first use; texture
/// coordinates, groups and materials do not split vertices. Missing, zero or unusable normals are
/// computed, weighted by angle; vertices that no triangle uses get (0, 0, 1) then.
///
/// Coordinates are read in double precision. A mesh that lies so far from its origin that single
/// precision would move its vertices gets an offset (Mesh::offset, whole metres); any other keeps
/// its coordinates.
///
/// Single triangles that run the other way round than their neighbours are turned. A closed surface
/// wound inside out (negative volume) is turned, with its normals; an open one stays as it is until
/// cameras tell (core/mesh/winding.h).
///
/// `notes`, where it is given, gets one line for each thing that was passed over or is doubtful,
/// without the file's name. `colours`, where it is given, gets those of the vertices, sRGB in [0,
/// 1], and is empty where there are none; then vertices of an OBJ of different colours stay apart.
/// Of a GLB they are COLOR_0 times the colour of the material and that of its picture at the
/// vertex. Throws Error (bad_input) for unreadable files, no triangles, NaN or infinite positions.
Mesh read_mesh(const std::filesystem::path& path, std::vector<std::string>* notes = nullptr,
               std::vector<Eigen::Vector3f>* colours = nullptr);

}  // namespace sheen::core
