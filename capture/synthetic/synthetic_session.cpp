// SPDX-License-Identifier: MIT
#include "capture/synthetic/synthetic_session.h"

#include "capture/calibration/camera_file.h"
#include "capture/pose/board.h"
#include "capture/pose/trajectory.h"
#include "capture/session/session_file.h"
#include "capture/synthetic/camera_path.h"
#include "capture/synthetic/hash.h"
#include "capture/synthetic/motion_jpeg_file.h"
#include "capture/synthetic/render_camera.h"
#include "capture/synthetic/torus_knot.h"
#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"
#include "core/files/write_file.h"
#include "core/image/png.h"
#include "core/mesh/bounds.h"
#include "core/mesh/read_mesh.h"

#include <Eigen/Geometry>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace sheen::capture::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr int kFps = 30;
constexpr int kHeldOutSamplesFactor = 4;
constexpr float kKnotLift = 0.01f;
constexpr double kMinRadius = 0.01;
constexpr double kMaxRadius = 2;

void require_range(const char* option, int value, int low, int high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(std::string(option) + ": " + std::to_string(value) + " is not in [" +
                              std::to_string(low) + ", " + std::to_string(high) + "]");
}

/// Counts images for the caller.
class Counter {
 public:
  Counter(const Progress& progress, int total) : progress_(progress), total_(total) {}
  void advance() {
    if (++done_; progress_) progress_(done_, total_);
  }

 private:
  const Progress& progress_;
  int total_;
  int done_ = 0;
};

std::vector<Trajectory::Entry> walk(const CameraPath& path, int views, bool closed) {
  std::vector<Trajectory::Entry> entries;
  for (int i = 0; i < views; ++i) {
    const double last = closed ? views : std::max(views - 1, 1);
    entries.push_back({static_cast<double>(i), path.board_from_camera(i / last)});
  }
  return entries;
}

/// Of one frame of a walk: the pose of its middle, or of each row while it is read.
std::vector<Eigen::Isometry3d> poses_of_rows(const CameraPath& path, std::size_t frame,
                                             const SyntheticOptions& options) {
  const int rows = options.readout_ms > 0 ? options.height_px : 1;
  const double last = options.path == PathKind::turntable ? options.frames : options.frames - 1;
  const double readout = 1e-3 * options.readout_ms * kFps;  // in frames
  std::vector<Eigen::Isometry3d> poses;
  for (int y = 0; y < rows; ++y) {
    const double share = (y + 0.5) / rows - 0.5;
    poses.push_back(path.board_from_camera((static_cast<double>(frame) + share * readout) / last));
  }
  return poses;
}

/// Files both sessions have: session.json, camera.yaml, object.ply.
void write_common(const fs::path& folder, const Scene& scene, const SyntheticOptions& options,
                  const core::CameraModel& camera, SessionFile session) {
  session.board_from_object = scene.board_from_object();
  write_session_file(folder, session);
  write_camera(folder / "camera.yaml", camera);
  const bool coarser = !options.mesh && options.mesh_vertices > 0;
  core::write_ply(folder / "object.ply",
                  coarser ? torus_knot(options.mesh_vertices) : scene.object());
}

/// Fine enough for what is near, far-reaching enough for what is large; of a Kinect's or better.
double depth_unit_m(const Scene& scene) {
  constexpr double large_m = 0.25;
  return scene.object_radius_m() < large_m ? 1e-4 : 1e-3;
}

std::string numbered_png(std::size_t number) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%04zu.png", number);
  return name.data();
}

void write_bytes(const fs::path& file, const std::vector<std::uint8_t>& png) {
  core::write_file(file, {reinterpret_cast<const char*>(png.data()), png.size()});
}

/// A depth image; what is farther than its 16 bits reach is not known.
std::vector<std::uint8_t> encode_depth(const cv::Mat& depth_m, double unit_m) {
  constexpr double most = std::numeric_limits<std::uint16_t>::max();
  cv::Mat steps;
  depth_m.convertTo(steps, CV_16U, 1 / unit_m);
  steps.setTo(0, steps == most);
  std::vector<std::uint8_t> png;
  cv::imencode(".png", steps, png);
  return png;
}

void write_recording(const fs::path& folder, const Scene& scene, const core::CameraModel& camera,
                     const SyntheticOptions& options, Counter& counter) {
  const bool turns = options.path == PathKind::turntable;
  const CameraPath path(turns ? turntable_path(0) : recording_path(options.seed),
                        scene.object_centre(), scene.object_radius_m());
  const std::vector<Trajectory::Entry> poses = walk(path, options.frames, turns);
  const double unit_m = depth_unit_m(scene);
  write_common(
      folder, scene, options, camera,
      {.video = "frames.avi",
       .fps = kFps,
       .depth = options.depth ? std::optional(DepthFiles{"depth/%04d.png", unit_m}) : std::nullopt,
       .board = "board.yaml"});
  if (options.depth) fs::create_directories(folder / "depth");
  write_board(folder / "board.yaml", scene.board());
  write_trajectory(folder / "truth_poses.txt", poses);

  MotionJpegFile video(folder / "frames.avi", {options.width_px, options.height_px}, kFps,
                       options.jpeg_quality);
  const RenderCamera render_camera(camera);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::uint32_t seed = hash(options.seed, static_cast<std::uint32_t>(i));
    const std::vector<Eigen::Isometry3d> rows = poses_of_rows(path, i, options);
    const Exposure exposure =
        render_camera.expose(scene, rows, options.samples, seed, options.threads);
    video.append(develop(exposure.light, SensorNoise{}, hash(seed, 1U)));
    if (options.depth) {
      const cv::Mat depth_m =
          render_camera.depth_m(scene, poses[i].board_from_camera, options.threads);
      write_bytes(folder / "depth" / numbered_png(i), encode_depth(depth_m, unit_m));
    }
    counter.advance();
  }
  video.close();
}

void write_held_out(const fs::path& folder, const Scene& scene, const core::CameraModel& camera,
                    const SyntheticOptions& options, Counter& counter) {
  const CameraPath path(options.path == PathKind::turntable ? turntable_path(180.0 / options.frames)
                                                            : held_out_path(options.seed),
                        scene.object_centre(), scene.object_radius_m());
  const std::vector<Trajectory::Entry> poses = walk(path, options.held_out, true);
  fs::create_directories(folder / "images");
  write_common(folder, scene, options, camera, {.images = "images/%04d.png", .poses = "poses.txt"});
  write_trajectory(folder / "poses.txt", poses);

  const RenderCamera render_camera(camera);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Exposure exposure = render_camera.expose(
        scene, poses[i].board_from_camera, kHeldOutSamplesFactor * options.samples,
        hash(options.seed, static_cast<std::uint32_t>(i), 2U), options.threads);
    write_bytes(folder / "images" / numbered_png(i),
                core::encode_png(develop(exposure.light, kNoNoise, 0)));
    counter.advance();
  }
}

}  // namespace

void SyntheticOptions::check() const {
  require_range("vertices", vertices, kMinKnotVertices, kMaxKnotVertices);
  if (mesh_vertices != 0) {
    require_range("mesh-vertices", mesh_vertices, kMinKnotVertices, kMaxKnotVertices);
  }
  require_range("width", width_px, 160, 4096);
  require_range("height", height_px, 120, 4096);
  require_range("frames", frames, 2, 100'000);
  require_range("held-out", held_out, 0, 10'000);
  require_range("samples", samples, 1, 256);
  require_range("quality", jpeg_quality, 1, 100);
  if (!(readout_ms >= 0 && readout_ms <= 1000.0 / kFps)) {
    throw std::invalid_argument("readout-ms: must be 0 to 33, the time from frame to frame");
  }
  if (threads < 1) throw std::invalid_argument("threads: must be at least 1");
}

core::CameraModel synthetic_camera(int width_px, int height_px) {
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = width_px;
  intrinsics.height_px = height_px;
  const double focal = 0.9 * std::max(width_px, height_px);
  intrinsics.focal_px = {focal, 1.002 * focal};
  intrinsics.principal_px = {0.5 * width_px + 3.2, 0.5 * height_px - 2.6};
  intrinsics.distortion = {-0.12, 0.05, 1e-3, -8e-4, 0, 0, 0, 0};
  return core::CameraModel(intrinsics);
}

Scene make_scene(const SyntheticOptions& options) {
  if (!options.mesh) {
    return {options.scene, torus_knot(options.vertices), kKnotLift, options.threads};
  }
  core::Mesh mesh = core::read_mesh(*options.mesh);
  const double radius = 0.5 * static_cast<double>(core::bounds_of(mesh).sizes().maxCoeff());
  if (!(radius >= kMinRadius && radius <= kMaxRadius)) {
    throw core::bad_input(*options.mesh, "is " + std::to_string(2 * radius) + " m across",
                          "give a mesh in metres, between 0.02 and 4 across");
  }
  return {options.scene, std::move(mesh), 0.0f, options.threads};
}

void write_synthetic_session(const fs::path& folder, const SyntheticOptions& options,
                             const Progress& progress) {
  options.check();
  const Scene scene = make_scene(options);
  const core::CameraModel camera = synthetic_camera(options.width_px, options.height_px);
  core::StagedOutput staged(folder);
  fs::create_directories(staged.path());
  Counter counter(progress, options.frames + options.held_out);
  write_recording(staged.path(), scene, camera, options, counter);
  if (options.held_out > 0) {
    write_held_out(staged.path() / "held_out", scene, camera, options, counter);
  }
  staged.commit();
}

}  // namespace sheen::capture::synthetic
