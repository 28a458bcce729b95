// SPDX-License-Identifier: MIT
#include "capture/dataset/import_session.h"

#include "capture/calibration/camera_file.h"
#include "capture/pose/trajectory.h"
#include "capture/session/session_file.h"
#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"
#include "core/mesh/read_mesh.h"
#include "core/text/lower_case.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheen::capture {
namespace {

namespace fs = std::filesystem;

/// The ending that all images share: the session's pattern has one.
std::string common_ending(const Dataset& dataset, const fs::path& folder) {
  const std::string first = fs::path(dataset.frames.front().image).extension().string();
  for (const DatasetFrame& frame : dataset.frames) {
    const bool same =
        core::lower_case(fs::path(frame.image).extension().string()) == core::lower_case(first);
    if (!same || first.find('%') != std::string::npos) {
      throw core::bad_input(folder / frame.image, "has another ending than the other images",
                            "convert all images to one format");
    }
  }
  return core::lower_case(first);
}

/// Copies the mesh once it is known to be one, or writes it in metres. Returns its name.
std::string put_mesh(const SessionImport& import, const fs::path& folder) {
  core::Mesh mesh = core::read_mesh(import.mesh);
  if (!import.mesh_has_unit || import.metres_per_unit == 1) {
    const std::string name = "object" + core::lower_case(import.mesh.extension().string());
    copy_into_session(import.mesh, folder / name);
    return name;
  }
  for (Eigen::Vector3f& position : mesh.positions) {
    position = (import.metres_per_unit * (position.cast<double>() + mesh.offset)).cast<float>();
  }
  core::write_ply(folder / "object.ply", mesh);
  return "object.ply";
}

}  // namespace

void write_imported_session(const SessionImport& import, const fs::path& folder) {
  Dataset dataset = import.dataset;
  if (dataset.cameras.size() != 1) {
    throw core::bad_input(import.images,
                          fmt::format("was taken by {} cameras", dataset.cameras.size()),
                          "a session has one: let the program that posed the images share them");
  }
  std::error_code no_throw;
  if (fs::exists(folder, no_throw)) {
    throw core::bad_input(folder, "exists already", "choose another name for the session");
  }
  std::sort(dataset.frames.begin(), dataset.frames.end(),
            [](const auto& a, const auto& b) { return a.image < b.image; });
  const std::string ending = common_ending(dataset, import.images);

  core::StagedOutput staged(folder);
  fs::create_directories(staged.path() / "images");
  std::vector<Trajectory::Entry> poses;
  for (std::size_t i = 0; i < dataset.frames.size(); ++i) {
    const DatasetFrame& frame = dataset.frames[i];
    copy_into_session(import.images / frame.image,
                      staged.path() / "images" / fmt::format("{:06d}{}", i, ending));
    Eigen::Isometry3d pose = frame.world_from_camera;
    pose.translation() *= import.metres_per_unit;
    poses.push_back({static_cast<double>(i), import.board_from_world * pose});
  }
  const std::string mesh = put_mesh(import, staged.path());
  write_camera(staged.path() / "camera.yaml", dataset.cameras.front());
  write_trajectory(staged.path() / "poses.txt", poses);
  SessionFile file{.images = "images/%06d" + ending,
                   .poses = "poses.txt",
                   .mesh = mesh,
                   .board_from_object = import.board_from_world};
  if (!import.board.empty()) {
    copy_into_session(import.board, staged.path() / "board.yaml");
    file.board = "board.yaml";
  }
  write_session_file(staged.path(), file);
  staged.commit();
}

}  // namespace sheen::capture
