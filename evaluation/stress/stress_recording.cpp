// SPDX-License-Identifier: MIT
#include "evaluation/stress/stress_recording.h"

#include "capture/calibration/camera_file.h"
#include "capture/pose/trajectory.h"
#include "capture/session/session_file.h"
#include "capture/synthetic/camera_path.h"
#include "capture/synthetic/hash.h"
#include "capture/synthetic/scene.h"
#include "capture/synthetic/synthetic_session.h"
#include "capture/synthetic/torus_knot.h"
#include "core/diagnostics/error.h"
#include "core/mesh/ply_file.h"

#include <fmt/core.h>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>

namespace sheen::evaluation {
namespace {

namespace fs = std::filesystem;
using capture::synthetic::CameraPath;

StressRecording film(const capture::synthetic::Scene& scene, const core::CameraModel& camera,
                     const CameraPath& path, int frames, double last, int samples,
                     const StressOptions& options) {
  StressRecording recording{.light = {},
                            .board_from_camera = {},
                            .posed_from_file = {},
                            .camera = camera,
                            .board = scene.board(),
                            .mesh = scene.object(),
                            .board_from_object = scene.board_from_object(),
                            .noise = {}};
  const capture::synthetic::RenderCamera lens(camera);
  for (int i = 0; i < frames; ++i) {
    recording.board_from_camera.push_back(path.board_from_camera(i / last));
    recording.light.push_back(
        lens.expose(scene, recording.board_from_camera.back(), samples,
                    capture::synthetic::hash(options.seed, static_cast<std::uint32_t>(i)),
                    options.threads)
            .light);
  }
  return recording;
}

void write_images(const fs::path& folder, const StressRecording& recording, std::uint32_t seed) {
  fs::create_directories(folder / "images");
  for (std::size_t i = 0; i < recording.light.size(); ++i) {
    const fs::path file = folder / "images" / fmt::format("{:04}.png", i);
    const std::uint32_t noise_seed =
        capture::synthetic::hash(seed, static_cast<std::uint32_t>(i), 7U);
    const cv::Mat image =
        capture::synthetic::develop(recording.light[i], recording.noise, noise_seed);
    if (!cv::imwrite(file.string(), image, {cv::IMWRITE_PNG_COMPRESSION, 1})) {
      throw core::Error(core::Error::Kind::run_failed, file, "cannot be written",
                        "check free space and permissions");
    }
  }
}

void write_poses(const fs::path& file, const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<capture::Trajectory::Entry> entries;
  for (const Eigen::Isometry3d& pose : poses) {
    entries.push_back({static_cast<double>(entries.size()), pose});
  }
  capture::write_trajectory(file, entries);
}

void write_one_session(const fs::path& folder, const StressRecording& recording,
                       std::uint32_t seed) {
  const bool has_poses = !recording.posed_from_file.empty();
  write_images(folder, recording, seed);
  capture::write_camera(folder / "camera.yaml", recording.camera);
  core::write_ply(folder / "object.ply", recording.mesh);
  capture::SessionFile session{.images = "images/%04d.png", .fps = 30};
  session.board_from_object = recording.board_from_object;
  if (has_poses) {
    session.poses = "poses.txt";
    write_poses(folder / "poses.txt", recording.posed_from_file);
  } else {
    session.board = "board.yaml";
    capture::write_board(folder / "board.yaml", recording.board);
  }
  capture::write_session_file(folder, session);
}

}  // namespace

StressBase render_stress_base(const StressOptions& options) {
  using namespace capture::synthetic;
  constexpr float lift_m = 0.01f;
  constexpr int held_out_factor = 4;  // cleaner than what is fitted
  const capture::synthetic::Scene scene(SceneKind::mixed, torus_knot(options.vertices), lift_m,
                                        options.threads);
  const core::CameraModel camera = synthetic_camera(options.width_px, options.height_px);
  const auto path = [&](const CameraPath::Options& walk) {
    return CameraPath(walk, scene.object_centre(), scene.object_radius_m());
  };
  StressBase base{film(scene, camera, path(recording_path(options.seed)), options.frames,
                       std::max(options.frames - 1, 1), options.samples, options),
                  film(scene, camera, path(held_out_path(options.seed)), options.held_out,
                       std::max(options.held_out, 1), held_out_factor * options.samples, options)};
  base.held_out.posed_from_file = base.held_out.board_from_camera;
  base.held_out.noise = kNoNoise;
  return base;
}

void write_stress_session(const fs::path& folder, const StressRecording& recording,
                          const StressRecording& held_out, std::uint32_t seed) {
  fs::create_directories(folder);
  write_one_session(folder, recording, seed);
  write_one_session(folder / "held_out", held_out, seed);
}

}  // namespace sheen::evaluation
