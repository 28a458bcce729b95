// SPDX-License-Identifier: MIT
// A session's mesh, or a mesh file's, in the board's frame with at most so many triangles.
#include "capture/session/session.h"
#include "core/diagnostics/error.h"
#include "core/mesh/read_mesh.h"
#include "core/mesh/repair.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <meshoptimizer.h>

#include <cstdio>
#include <exception>

namespace sheen::bench {
namespace {

struct DecimateOptions {
  std::filesystem::path source;
  std::filesystem::path output;
  std::size_t triangles = 0;
};

core::Mesh read_in_board_frame(const std::filesystem::path& source) {
  if (!std::filesystem::is_directory(source)) return core::read_mesh(source);
  capture::Session session = capture::open_session(source);
  core::Mesh mesh = core::read_mesh(session.mesh);
  session.take_offset(mesh.offset);
  for (auto& p : mesh.positions) p = (session.board_from_object * p.cast<double>()).cast<float>();
  const Eigen::Matrix3f turn = session.board_from_object.linear().cast<float>();
  for (auto& normal : mesh.normals) normal = turn * normal;
  mesh.offset.setZero();
  return mesh;
}

/// Edge collapses of least quadric error. Hard edges are joined first: collapses would open them.
void decimate(std::size_t triangles, core::Mesh& mesh) {
  for (auto& normal : mesh.normals) normal = {0, 0, 1};
  std::vector<Eigen::Vector3f> no_colours;
  core::join_identical_vertices(mesh, no_colours);
  std::vector<unsigned> kept(3 * mesh.triangles.size());
  const std::size_t indices = meshopt_simplify(
      kept.data(), mesh.triangles.front().data(), kept.size(), mesh.positions.front().data(),
      mesh.positions.size(), sizeof(Eigen::Vector3f), 3 * triangles, 1, 0, nullptr);
  mesh.triangles.clear();
  for (std::size_t i = 0; i < indices; i += 3) {
    mesh.triangles.emplace_back(kept[i], kept[i + 1], kept[i + 2]);
  }
  core::join_identical_vertices(mesh, no_colours);  // loses those that are left over
  mesh.normals.clear();
  core::complete_normals(mesh);
}

void run(const DecimateOptions& options) {
  core::Mesh mesh = read_in_board_frame(options.source);
  if (options.triangles > 0 && mesh.triangles.size() > options.triangles) {
    decimate(options.triangles, mesh);
  }
  core::write_ply(options.output, mesh);
  fmt::print("{}\n", mesh.triangles.size());
}

}  // namespace
}  // namespace sheen::bench

int main(int argc, char** argv) {
  sheen::bench::DecimateOptions options;
  CLI::App app(
      "Writes a mesh in the board's frame with at most so many triangles; prints how many");
  app.add_option("source", options.source, "Session folder or mesh file")->required();
  app.add_option("-o,--output", options.output, "Mesh file (.ply)")->required();
  app.add_option("--triangles", options.triangles, "At most; 0: as it is")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    sheen::bench::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
