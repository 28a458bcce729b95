// SPDX-License-Identifier: MIT
#include "core/mesh/read_mesh.h"

#include "core/diagnostics/error.h"
#include "core/mesh/gltf_file.h"
#include "core/mesh/obj_file.h"
#include "core/mesh/ply_file.h"
#include "core/mesh/repair.h"
#include "core/mesh/winding.h"
#include "core/text/lower_case.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>

namespace sheen::core {
namespace {

namespace fs = std::filesystem;

constexpr double kFarAway = 64;  // sizes of the mesh from its origin: rounding is 4e-6 of its size
constexpr double kFarthest_m = 1e9;
constexpr double kDoubtfulGrid = 1e-4,
                 kUselessGrid = 0.02;  // steps of positions, of the mesh's size
constexpr double kContradicting = 0.9, kFewContradicting = 0.1;  // shares of the normals

/// What files begin with whose ending says something else.
struct FileKind {
  const char* start;
  const char* ending;  ///< null for what is not read
  const char* name;
};
constexpr FileKind kFileKinds[] = {{"glTF", ".glb", "binary glTF"},
                                   {"ply", ".ply", "PLY"},
                                   {"solid ", nullptr, "STL"},
                                   {"Kaydara FBX", nullptr, "FBX"},
                                   {"PK", nullptr, "ZIP"},
                                   {"<?xml", nullptr, "XML"},
                                   {"{", nullptr, "JSON (glTF text)"},
                                   {"<!DOCTYPE", nullptr, "web page"},
                                   {"<html", nullptr, "web page"}};
// Git leaves it in place of a large file that was not fetched.
constexpr const char* kLargeFilePointer = "version https://";

/// Its only mark: 80 bytes of anything, then the number of triangles, of which each has 50 bytes.
bool is_binary_stl(const fs::path& path, std::ifstream& file) {
  unsigned char count[4] = {};
  file.clear();
  file.seekg(80);
  if (!file.read(reinterpret_cast<char*>(count), sizeof(count))) return false;
  const std::uint64_t triangles = count[0] | std::uint64_t{count[1]} << 8U |
                                  std::uint64_t{count[2]} << 16U | std::uint64_t{count[3]} << 24U;
  std::error_code failure;
  return triangles > 0 && fs::file_size(path, failure) == 84 + 50 * triangles;
}

void check_kind(const fs::path& path, const std::string& extension) {
  std::ifstream file(path, std::ios::binary);
  std::string start(16, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start.starts_with(kLargeFilePointer)) {
    throw bad_input(path, "is a pointer of Git LFS, not the file", "fetch it: git lfs pull");
  }
  if (is_binary_stl(path, file)) {
    throw bad_input(path, "is a file of kind STL, whatever its ending",
                    "convert it to PLY, OBJ or GLB");
  }
  for (const FileKind& kind : kFileKinds) {
    if (!start.starts_with(kind.start)) continue;
    if (kind.ending != nullptr && extension == kind.ending) return;
    throw bad_input(path, std::string("is a file of kind ") + kind.name + ", whatever its ending",
                    kind.ending != nullptr ? std::string("give it the ending ") + kind.ending
                                           : "convert it to PLY, OBJ or GLB");
  }
}

void check_file(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension != ".ply" && extension != ".obj" && extension != ".glb") {
    throw bad_input(path, "is not a mesh format that can be read",
                    "convert it to PLY, OBJ or GLB, for instance in Blender or MeshLab");
  }
  std::error_code failure;
  if (!fs::exists(path, failure)) throw bad_input(path, "does not exist", "check the name");
  if (!fs::is_regular_file(path, failure)) {
    throw bad_input(path, "is not a file", "give a PLY, OBJ or GLB file");
  }
  if (fs::file_size(path, failure) == 0) {
    throw bad_input(path, "is empty", "write the mesh again");
  }
  check_kind(path, extension);
}

MeshFile read_mesh_file(const fs::path& path, VertexColours colours) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".ply") return read_ply(path);
  return extension == ".obj" ? read_obj(path, colours) : read_glb(path, colours);
}

[[noreturn]] void refuse_position(std::size_t vertex, const fs::path& path) {
  throw bad_input(
      path, "has a position that is not a finite number (vertex " + std::to_string(vertex) + ")",
      "repair the mesh");
}

Eigen::AlignedBox3d bounds_of(const MeshFile& file) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : file.positions) box.extend(position);
  return box;
}

/// What is taken out before rounding: nothing, or the middle in whole metres.
Eigen::Vector3d offset_of(const Eigen::AlignedBox3d& box) {
  const double farthest =
      std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  if (!(farthest > kFarAway * box.diagonal().norm()) || farthest > kFarthest_m) {
    return Eigen::Vector3d::Zero();
  }
  return box.center().array().round();
}

/// Distance of neighbouring numbers of single precision at `value`.
double single_step(double value) {
  const float magnitude = std::abs(static_cast<float>(value));
  return static_cast<double>(std::nextafter(magnitude, 2 * magnitude + 1)) -
         static_cast<double>(magnitude);
}

/// Whether another program has rounded the positions to single precision already: all are such
/// numbers, and not simply whole.
bool is_rounded(const MeshFile& file) {
  bool has_fraction = false;
  for (const Eigen::Vector3d& position : file.positions) {
    for (const double value : position) {
      if (static_cast<double>(static_cast<float>(value)) != value) return false;
      has_fraction |= value != std::floor(value);
    }
  }
  return has_fraction;
}

/// What single precision in the file itself has done to a mesh far from its origin.
void judge_grid(const MeshFile& file, const Eigen::AlignedBox3d& box, const fs::path& path,
                std::vector<std::string>& notes) {
  const double farthest =
      std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const double step = single_step(farthest);
  const double size = box.diagonal().norm();
  if (!(step > kDoubtfulGrid * size) || !is_rounded(file)) return;
  char fault[160];
  std::snprintf(
      fault, sizeof(fault),
      "stores positions in single precision %.4g km from the origin, where they stand on a "
      "grid of %.3g mm",
      farthest / 1000, 1000 * step);
  const char* const remedy = "export it in double precision or move it to the origin first";
  if (step > kUselessGrid * size) throw bad_input(path, fault, remedy);
  notes.push_back(std::string(fault) + "; " + remedy);
}

/// Vertices that no triangle uses and that lie far off the surface, as cleaned scans leave them,
/// are no part of it: they move to one that is, so that none of them counts for its size or place.
/// They keep their numbers.
void place_unused(MeshFile& file, std::vector<std::string>& notes) {
  if (file.triangles.empty()) return;
  std::vector<std::uint8_t> is_used(file.positions.size(), 0);
  for (const auto& triangle : file.triangles) {
    for (const std::uint32_t corner : triangle) is_used[corner] = 1;
  }
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i] != 0) box.extend(file.positions[i]);
  }
  const Eigen::Vector3d place = file.positions[file.triangles.front()[0]];
  std::size_t far_off = 0;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i] != 0) continue;
    const Eigen::Vector3d& unused = file.positions[i];
    if (unused.allFinite() && box.exteriorDistance(unused) <= box.diagonal().norm()) continue;
    file.positions[i] = place;
    ++far_off;
  }
  if (far_off == 0) return;
  notes.push_back(std::to_string(far_off) +
                  " of its vertices belong to no triangle and lie far off the surface; they are "
                  "passed over");
}

Mesh rounded(MeshFile&& file, const fs::path& path, std::vector<std::string>& notes) {
  place_unused(file, notes);
  for (std::size_t i = 0; i < file.positions.size(); ++i) {
    if (!file.positions[i].allFinite()) refuse_position(i, path);
  }
  Mesh mesh;
  if (!file.positions.empty()) {
    const Eigen::AlignedBox3d box = bounds_of(file);
    mesh.offset = offset_of(box);
    judge_grid(file, box, path, notes);
  }
  mesh.positions.reserve(file.positions.size());
  for (std::size_t i = 0; i < file.positions.size(); ++i) {
    mesh.positions.push_back((file.positions[i] - mesh.offset).cast<float>());
    if (!mesh.positions.back().allFinite()) refuse_position(i, path);
  }
  mesh.normals = std::move(file.normals);
  mesh.triangles = std::move(file.triangles);
  return mesh;
}

/// Normals that contradict the triangles: turned where the triangles are surely right.
void judge_normals(Mesh& mesh, std::vector<std::string>& notes) {
  const double against = normals_against_winding(mesh);
  if (against >= kContradicting && is_closed(mesh)) {
    for (Eigen::Vector3f& normal : mesh.normals) normal = -normal;
    notes.emplace_back("its normals pointed inwards and were turned");
  } else if (against > kFewContradicting && against < kContradicting) {
    notes.push_back(std::to_string(std::lround(100 * against)) +
                    " % of its normals contradict the winding of its triangles; write it again "
                    "without normals to have them computed");
  }
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path, std::vector<std::string>* notes,
               std::vector<Eigen::Vector3f>* colours) {
  // Load.
  check_file(path);
  MeshFile file =
      read_mesh_file(path, colours != nullptr ? VertexColours::read : VertexColours::unread);
  std::vector<std::string> said = std::move(file.notes);
  std::vector<Eigen::Vector3f> vertex_colours;
  if (colours != nullptr) vertex_colours = std::move(file.colours);
  Mesh mesh = rounded(std::move(file), path, said);

  // Repair, from the corners to the surface.
  if (lower_case(path.extension().string()) == ".obj")
    join_identical_vertices(mesh, vertex_colours);
  drop_degenerate_triangles(mesh);
  if (mesh.positions.empty()) {
    throw bad_input(path, "holds no vertex", "check that it is a mesh, whatever its name");
  }
  if (mesh.triangles.empty()) {
    throw bad_input(path, "has no triangles", "give a surface, not a point cloud");
  }
  if (const std::size_t turned = unify_winding(mesh); turned > 0) {
    said.push_back(
        std::to_string(turned) +
        " of its triangles ran the other way round than their neighbours and were turned");
  }
  turn_inside_out_surface(mesh);
  judge_normals(mesh, said);
  complete_normals(mesh);
  if (notes != nullptr) *notes = std::move(said);
  if (colours != nullptr) *colours = std::move(vertex_colours);
  return mesh;
}

}  // namespace sheen::core
