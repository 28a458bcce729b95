// SPDX-License-Identifier: MIT
// A printed ball, drawn by rays, that is shifted by a known way from a known frame on.
#include "pipeline/evidence/print_evidence.h"

#include "core/samples/surface_points.h"
#include "core/visibility/raster_visibility.h"
#include "pipeline/view_observer.h"
#include "tests/capture/rendered_board.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sheen::pipeline {
namespace {

using capture::test::look_at_board;

constexpr double kRadius_m = 0.05;
constexpr int kFrames = 48, kMoved = 26;

/// Latitudes and longitudes.
core::Mesh ball() {
  constexpr int rings = 24, steps = 36;
  core::Mesh mesh;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int step = 0; step < steps; ++step) {
      const double polar = std::numbers::pi * (ring + 0.5) / (rings + 1);
      const double turn = 2 * std::numbers::pi * step / steps;
      const Eigen::Vector3f normal(static_cast<float>(std::sin(polar) * std::cos(turn)),
                                   static_cast<float>(std::sin(polar) * std::sin(turn)),
                                   static_cast<float>(std::cos(polar)));
      mesh.positions.push_back(static_cast<float>(kRadius_m) * normal);
      mesh.normals.push_back(normal);
      if (ring == rings) continue;
      const auto here = static_cast<std::uint32_t>(ring * steps + step);
      const auto next = static_cast<std::uint32_t>(ring * steps + (step + 1) % steps);
      mesh.triangles.push_back({here, here + steps, next});
      mesh.triangles.push_back({next, here + steps, next + steps});
    }
  }
  return mesh;
}

/// Print with detail of some millimetres in every direction.
double luma_at(const Eigen::Vector3d& p) {
  constexpr double k = 2 * std::numbers::pi / 0.008;
  return 0.5 + 0.15 * (std::sin(k * p.x() + 1) + std::sin(k * p.y() + 2) + std::sin(k * p.z()));
}

/// The ball, its middle at `middle`; a highlight goes with the camera where it is wanted.
cv::Mat photograph(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                   const Eigen::Vector3d& middle, bool is_glossy) {
  const Eigen::Isometry3d object_from_camera = camera_from_object.inverse();
  const Eigen::Vector3d eye = object_from_camera.translation();
  cv::Mat image(camera.height_px(), camera.width_px(), CV_8UC3, cv::Scalar::all(60));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const Eigen::Vector3d ray =
          (object_from_camera.linear() * *camera.unproject({x, y})).normalized();
      const double along = ray.dot(middle - eye);
      const double off2 = (middle - eye).squaredNorm() - along * along;
      if (off2 > kRadius_m * kRadius_m) continue;
      const Eigen::Vector3d p =
          eye + (along - std::sqrt(kRadius_m * kRadius_m - off2)) * ray - middle;
      const Eigen::Vector3d halfway =
          (Eigen::Vector3d(0.3, 0.2, 0.9).normalized() - ray).normalized();
      const double gloss =
          is_glossy ? 0.4 * std::pow(std::max(0.0, halfway.dot(p) / kRadius_m), 40) : 0;
      image.at<cv::Vec3b>(y, x) =
          cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(255 * std::min(1.0, luma_at(p) + gloss)));
    }
  }
  return image;
}

struct Moved {
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  bool is_glossy = false;
  double mesh_scale = 1;
};

PrintEvidence seen(const core::Mesh& mesh, const Moved& moved) {
  const core::CameraModel camera = capture::test::make_camera(320, 240, false);
  ViewObserver observer(mesh, core::make_raster_visibility(mesh, 1), {}, 1);
  PrintEvidence evidence(mesh);
  for (int i = 0; i < kFrames; ++i) {
    // Three times round, up and down.
    const Eigen::Isometry3d pose =
        look_at_board(0.22, 0.7 + 0.3 * std::sin(0.9 * i), 2 * std::numbers::pi * 3 * i / kFrames);
    const cv::Mat image = photograph(
        camera, pose, i < kMoved ? Eigen::Vector3d(0, 0, 0) : moved.shift_m, moved.is_glossy);
    evidence.look_at(i, image, observer.see(camera, pose), camera, pose);
  }
  return evidence;
}

// 1 mm at .22 m and 251 px of focal length is 1.1 px. What a first-order model of a print of 8 mm
// makes of it is short by a sixth: sin(x) / x for x = 2 pi / 8 is .90, twice smoothed by 1 px.
TEST(PrintEvidence, AShiftIsFoundWithItsFrame) {
  const core::Mesh mesh = ball();
  const Eigen::Vector3d shift(0.0008, -0.0005, 0.0003);
  for (const bool is_glossy : {false, true}) {
    const PrintEvidence evidence = seen(mesh, {shift, is_glossy});
    const auto jump = evidence.jump();
    ASSERT_TRUE(jump);
    EXPECT_EQ(jump->frame_index, kMoved);
    EXPECT_LT((jump->shift_m - shift).norm(), 0.25 * shift.norm()) << jump->shift_m.transpose();
    ASSERT_EQ(evidence.findings().size(), 1u);
    EXPECT_EQ(evidence.findings()[0].cause, "object-moved");
  }
}

// Gloss, and a mesh that is 3 % too large, do not look like an object that moves.
TEST(PrintEvidence, AnObjectAtRestIsNotTakenForOneThatMoves) {
  const core::Mesh mesh = ball();
  EXPECT_TRUE(seen(mesh, {}).findings().empty());
  EXPECT_TRUE(seen(mesh, {.is_glossy = true}).findings().empty());
  core::Mesh large = mesh;
  for (Eigen::Vector3f& position : large.positions) position *= 1.03f;
  EXPECT_TRUE(seen(large, {.is_glossy = true}).findings().empty());
}

TEST(PrintEvidence, NothingSeenTellsNothing) {
  const core::Mesh mesh = ball();
  EXPECT_FALSE(PrintEvidence(mesh).jump());
}

}  // namespace
}  // namespace sheen::pipeline
