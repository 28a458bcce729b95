// SPDX-License-Identifier: MIT
#include "core/mesh/read_mesh.h"

#include "core/diagnostics/error.h"
#include "core/mesh/glb_guard.h"
#include "core/mesh/ply_file.h"
#include "core/mesh/repair.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace sheen::core {
namespace {

namespace fs = std::filesystem;

/// More is no surface that a camera can tell apart; a small file may ask for it by instancing.
constexpr std::size_t kMostVertices = 20'000'000;
constexpr std::size_t kMostTriangles = 2 * kMostVertices;  // of a closed surface

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void check_file(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension != ".ply" && extension != ".obj" && extension != ".glb") {
    throw bad_input(path, "is not a mesh format that can be read", "convert it to PLY, OBJ or GLB");
  }
  std::error_code failure;
  if (!fs::exists(path, failure)) throw bad_input(path, "does not exist", "check the name");
  if (!fs::is_regular_file(path, failure)) {
    throw bad_input(path, "is not a file", "give a PLY, OBJ or GLB file");
  }
  if (fs::file_size(path, failure) == 0) {
    throw bad_input(path, "is empty", "write the mesh again");
  }
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  return text;
}

/// Loads without any post-processing, which would merge and reorder vertices, and checks what
/// later steps take on trust.
const aiScene& load_scene(Assimp::Importer& importer, const fs::path& path) {
  const aiScene* scene = importer.ReadFile(path.string(), 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw bad_input(path, "cannot be read as a mesh (" + one_line(importer.GetErrorString()) + ")",
                    "it may be cut short; write it again");
  }
  bool has_polygons = false;
  for (const aiMesh* mesh : std::span(scene->mMeshes, scene->mNumMeshes)) {
    for (unsigned f = 0; f < mesh->mNumFaces; ++f) {
      const aiFace& face = mesh->mFaces[f];
      has_polygons |= face.mNumIndices > 3;
      if (std::any_of(face.mIndices, face.mIndices + face.mNumIndices,
                      [mesh](unsigned index) { return index >= mesh->mNumVertices; })) {
        throw bad_input(path, "has a face with a corner that does not exist", "write it again");
      }
    }
  }
  if (has_polygons) scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr) {
    throw bad_input(path, "has polygons that cannot be cut into triangles",
                    "triangulate it before");
  }
  return *scene;
}

Eigen::Vector3f vector_of(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

/// Appends one mesh of the scene. Normals stay empty until a mesh brings some.
void append(const aiMesh& source, const aiMatrix4x4& object_from_mesh, Mesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  const aiMatrix3x3 linear(object_from_mesh);
  const bool mirrors = linear.Determinant() < 0;
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    mesh.positions.push_back(vector_of(object_from_mesh * source.mVertices[i]));
  }
  if (source.mNormals != nullptr) {
    // A matrix without inverse gives NaN here; such normals are computed anew later.
    aiMatrix3x3 turn_normal = linear;
    turn_normal.Inverse().Transpose();
    mesh.normals.resize(base, Eigen::Vector3f::Zero());
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
      mesh.normals.push_back(vector_of(turn_normal * source.mNormals[i]));
    }
  }
  for (unsigned f = 0; f < source.mNumFaces; ++f) {
    const aiFace& face = source.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines have no surface
    mesh.triangles.emplace_back(base + face.mIndices[0], base + face.mIndices[mirrors ? 2 : 1],
                                base + face.mIndices[mirrors ? 1 : 2]);
  }
}

/// All meshes of the scene in depth-first order of its nodes.
Mesh flattened(const aiScene& scene, const fs::path& path) {
  struct Visit {
    const aiNode* node;
    aiMatrix4x4 object_from_parent;
  };
  Mesh mesh;
  std::vector<Visit> open = {{scene.mRootNode, aiMatrix4x4()}};
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const aiMatrix4x4 object_from_node = visit.object_from_parent * visit.node->mTransformation;
    for (unsigned m = 0; m < visit.node->mNumMeshes; ++m) {
      const aiMesh& source = *scene.mMeshes[visit.node->mMeshes[m]];
      if (mesh.positions.size() + source.mNumVertices > kMostVertices ||
          mesh.triangles.size() + source.mNumFaces > kMostTriangles) {
        throw bad_input(path, "has more than 20 million vertices or 40 million triangles",
                        "simplify it");
      }
      append(source, object_from_node, mesh);
    }
    for (unsigned c = visit.node->mNumChildren; c > 0; --c) {
      open.push_back({visit.node->mChildren[c - 1], object_from_node});
    }
  }
  if (!mesh.normals.empty()) mesh.normals.resize(mesh.positions.size(), Eigen::Vector3f::Zero());
  return mesh;
}

void check_positions(const Mesh& mesh, const fs::path& path) {
  const auto bad = std::find_if(mesh.positions.begin(), mesh.positions.end(),
                                [](const Eigen::Vector3f& p) { return !p.allFinite(); });
  if (bad != mesh.positions.end()) {
    throw bad_input(path,
                    "has a position that is not a finite number (vertex " +
                        std::to_string(bad - mesh.positions.begin()) + ")",
                    "repair the mesh");
  }
}

Mesh read_by_assimp(const fs::path& path) {
  Assimp::Importer importer;
  return flattened(load_scene(importer, path), path);
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  // Load.
  check_file(path);
  const std::string extension = lower_extension(path);
  if (extension == ".glb") check_glb(path);
  Mesh mesh = extension == ".ply" ? read_ply(path) : read_by_assimp(path);

  // Repair, from the corners to the surface.
  check_positions(mesh, path);
  if (extension == ".obj") join_identical_vertices(mesh);
  drop_degenerate_triangles(mesh);
  if (mesh.triangles.empty()) {
    throw bad_input(path, "has no triangles", "give a surface, not a point cloud");
  }
  turn_inside_out_surface(mesh);
  complete_normals(mesh);
  return mesh;
}

}  // namespace sheen::core
