// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/synthetic/render_camera.h"
#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace sheen::evaluation {

/// How large the sessions are that are put under stress.
struct StressOptions {
  int width_px = 384;
  int height_px = 288;
  int vertices = 1500;
  int frames = 60;
  int held_out = 8;
  int samples = 4;  ///< rays per pixel
  std::uint32_t seed = 1;
  int threads = 1;
};

/// A recording in memory, as it was taken or as a damage leaves it. `board_from_camera` is the
/// truth; what the session's files say may differ from it.
struct StressRecording {
  std::vector<cv::Mat> light;  ///< CV_32FC3, linear RGB, 1 = white
  std::vector<Eigen::Isometry3d> board_from_camera;
  std::vector<Eigen::Isometry3d> posed_from_file;  ///< written as poses.txt; empty: poses from tags
  core::CameraModel camera;
  capture::Board board;
  core::Mesh mesh;
  Eigen::Isometry3d board_from_object = Eigen::Isometry3d::Identity();
  capture::synthetic::SensorNoise noise;
};

/// The knot on its board: a spiral of three rounds, and clean views that are held out.
struct StressBase {
  StressRecording recording;
  StressRecording held_out;
};
StressBase render_stress_base(const StressOptions& options);

/// One way in which sessions go wrong. `damage` changes a copy of the clean recording by a severity
/// in the unit named.
struct StressKind {
  std::string name;
  std::string unit;
  std::vector<double> severities;  ///< ascending in harm
  std::function<void(StressRecording&, double severity)> damage;
};

/// All of them; "none", with the one severity 0, first.
std::vector<StressKind> stress_kinds();

/// Writes a session folder with its held_out/ views. `seed` decides the noise.
void write_stress_session(const std::filesystem::path& folder, const StressRecording& recording,
                          const StressRecording& held_out, std::uint32_t seed);

}  // namespace sheen::evaluation
