// SPDX-License-Identifier: MIT
// One camera pose from the corners of many tags: the solver of capture/pose/joint_pose against
// Ceres from the same kind of start. Both minimise the same reprojection with the same robust loss.
#include "capture/pose/joint_pose.h"

#include "capture/pose/bundle_residuals.h"

#include <benchmark/benchmark.h>
#include <ceres/ceres.h>
#include <opencv2/calib3d.hpp>

#include <random>
#include <vector>

namespace sheen::capture {
namespace {

constexpr double kTag_m = 0.045;
constexpr double kHuber_px = 1;

const core::CameraModel kCamera({.width_px = 1280,
                                 .height_px = 720,
                                 .focal_px = {1011, 1005},
                                 .principal_px = {648, 352},
                                 .distortion = {-0.12, 0.05, 0.0008, -0.0006, -0.01}});

/// Corners of a board of so many tags, seen from half a metre with noise of a quarter of a pixel.
struct Scene {
  explicit Scene(int tags) {
    camera_from_board.linear() =
        Eigen::AngleAxisd(2.4, Eigen::Vector3d(0.95, 0.2, 0.1).normalized()).toRotationMatrix();
    camera_from_board.translation() = Eigen::Vector3d(0.01, 0.02, 0.5);
    board.family = "tag36h11";
    std::mt19937 random(7);
    std::normal_distribution<double> noise_px(0, 0.25);
    for (int id = 0; id < tags; ++id) {
      Board::Tag tag;
      tag.size_m = kTag_m;
      tag.board_from_tag.translation() << 0.058 * (id % 6 - 2.5), 0.058 * (id / 6 - 1.5), 0;
      board.tags[id] = tag;
      TagDetection detection;
      detection.id = id;
      for (std::size_t c = 0; c < 4; ++c) {
        detection.corners_px[c] = *kCamera.project(camera_from_board * tag.corners_in_board()[c]) +
                                  Eigen::Vector2d(noise_px(random), noise_px(random));
      }
      detections.push_back(detection);
    }
  }

  [[nodiscard]] double error_mm(const Eigen::Isometry3d& pose) const {
    return 1e3 * (pose.inverse().translation() - camera_from_board.inverse().translation()).norm();
  }

  Board board;
  std::vector<TagDetection> detections;
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
};

Eigen::Isometry3d start_of(const Scene& scene) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const TagDetection& detection : scene.detections) {
    const auto corners = scene.board.tags.at(detection.id).corners_in_board();
    for (std::size_t c = 0; c < 4; ++c) {
      points.emplace_back(corners[c].x(), corners[c].y(), corners[c].z());
      pixels.emplace_back(detection.corners_px[c].x(), detection.corners_px[c].y());
    }
  }
  const auto& lens = kCamera.intrinsics();
  const cv::Matx33d K(lens.focal_px.x(), 0, lens.principal_px.x(), 0, lens.focal_px.y(),
                      lens.principal_px.y(), 0, 0, 1);
  cv::Vec3d rotation;
  cv::Vec3d translation;
  cv::solvePnP(points, pixels, K,
               std::vector<double>(lens.distortion.begin(), lens.distortion.end()), rotation,
               translation, false, cv::SOLVEPNP_SQPNP);
  return to_isometry(Parameters{rotation[0], rotation[1], rotation[2], translation[0],
                                translation[1], translation[2]});
}

void own_solver(benchmark::State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  double error_mm = 0;
  for (auto _ : state) {
    error_mm = scene.error_mm(
        estimate_joint_pose(scene.board, kCamera, scene.detections)->camera_from_board);
  }
  state.counters["error_mm"] = error_mm;
}

void ceres_solver(benchmark::State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  double error_mm = 0;
  for (auto _ : state) {
    Parameters pose = to_parameters(start_of(scene));
    std::vector<Parameters> tags;
    for (const auto& [id, tag] : scene.board.tags)
      tags.push_back(to_parameters(tag.board_from_tag));
    ceres::Problem problem;
    for (const TagDetection& detection : scene.detections) {
      double* const tag = tags[static_cast<std::size_t>(detection.id)].data();
      problem.AddResidualBlock(tag_residual(kCamera, detection, kTag_m),
                               new ceres::HuberLoss(kHuber_px), pose.data(), tag);
      problem.SetParameterBlockConstant(tag);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    error_mm = scene.error_mm(to_isometry(pose));
  }
  state.counters["error_mm"] = error_mm;
}

BENCHMARK(own_solver)->Arg(4)->Arg(24)->Unit(benchmark::kMicrosecond);
BENCHMARK(ceres_solver)->Arg(4)->Arg(24)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sheen::capture
