// SPDX-License-Identifier: MIT
// From images to a surface: a ball on a sheet, drawn ray by ray.
#include "reconstruction/object/object_mesh.h"
#include "reconstruction/surface/self_intersection.h"
#include "tests/reconstruction/stage_for_tests.h"

#include <gtest/gtest.h>

#include <optional>

namespace sheen::reconstruction {
namespace {

constexpr double kBallRadius_m = 0.03;
const Eigen::Vector3d kBallCentre(0.005, -0.004, 0.032);

/// Where a ray meets the ball, in lengths of `direction`.
std::optional<double> meet_ball(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d from = eye - kBallCentre;
  const double a = direction.squaredNorm();
  const double b = from.dot(direction);
  const double root = b * b - a * (from.squaredNorm() - kBallRadius_m * kBallRadius_m);
  if (root < 0) return std::nullopt;
  return (-b - std::sqrt(root)) / a;
}

cv::Vec3d sheet_colour(const capture::Board& board, const Eigen::Vector2d& place) {
  for (const auto& [id, tag] : board.tags) {
    const Eigen::Vector2d from = place - tag.board_from_tag.translation().head<2>();
    if (from.cwiseAbs().maxCoeff() < 0.5 * tag.size_m) return {30, 30, 30};
  }
  return place.cwiseAbs().maxCoeff() < 0.15 ? cv::Vec3d(225, 225, 225) : cv::Vec3d(90, 110, 130);
}

/// Four rays a pixel.
cv::Mat draw(const core::CameraModel& camera, const capture::Board& board,
             const Eigen::Isometry3d& camera_from_board) {
  const Eigen::Isometry3d board_from_camera = camera_from_board.inverse();
  const Eigen::Vector3d eye = board_from_camera.translation();
  cv::Mat image(camera.height_px(), camera.width_px(), CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      cv::Vec3d sum(0, 0, 0);
      for (int sub = 0; sub < 4; ++sub) {
        const Eigen::Vector2d pixel(x - 0.25 + 0.5 * (sub % 2), y - 0.25 + 0.5 * (sub / 2));
        const Eigen::Vector3d direction =
            board_from_camera.linear() * camera.unproject(pixel).value();
        if (const auto way = meet_ball(eye, direction)) {
          const Eigen::Vector3d normal = (eye + *way * direction - kBallCentre) / kBallRadius_m;
          const double light = 0.6 + 0.4 * normal.z();
          sum += cv::Vec3d(50, 70, 190) * light;
        } else {
          const double down = direction.z() < -1e-6 ? -eye.z() / direction.z() : 1e6;
          sum += sheet_colour(board, (eye + down * direction).head<2>());
        }
      }
      for (int c = 0; c < 3; ++c) {
        image.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<std::uint8_t>(sum[c] / 4);
      }
    }
  }
  return image;
}

ObjectMesh measure(int threads) {
  const core::CameraModel camera = tests::small_camera(160, 120);
  const capture::Board board = tests::ring_board();
  std::vector<PosedImage> images;
  for (const double elevation : {20.0, 55.0}) {
    for (const auto& pose : tests::ring_of_poses(12, 0.4, elevation, {0, 0, 0.02})) {
      images.push_back({static_cast<int>(images.size()), draw(camera, board, pose), pose});
    }
  }
  return measure_object("walk", camera, board, images, threads, [](std::string_view, int, int) {});
}

TEST(MeasuredObject, IsTheBallToAFractionOfAPixel) {
  const ObjectMesh found = measure(1);
  EXPECT_TRUE(is_closed_manifold(found.mesh));
  EXPECT_TRUE(find_self_intersections(found.mesh, 1).empty());
  EXPECT_EQ(found.confidence.size(), found.mesh.positions.size());
  // A pixel is .4 m / 176 px = 2.3 mm there.
  double sum = 0;
  double worst = 0;
  std::size_t count = 0;
  for (const auto& p : found.mesh.positions) {
    const Eigen::Vector3d from = p.cast<double>() - kBallCentre;
    // Below there is nothing to see but the sheet, above no view looks along the surface: views at
    // 55 degrees show rims whose normals rise to 35 degrees, sin 35 = .57, lower ones see beyond
    // the map.
    if (from.z() < 0 || from.z() > 0.57 * kBallRadius_m) continue;
    const double error = std::abs(from.norm() - kBallRadius_m);
    sum += error;
    worst = std::max(worst, error);
    ++count;
  }
  EXPECT_NEAR(static_cast<double>(found.pixel_m), 0.0023, 0.0003);
  EXPECT_LT(sum / static_cast<double>(count), 0.0012);
  EXPECT_LT(worst, 0.004);
}

TEST(MeasuredObject, ThreadsChangeNoBit) {
  const ObjectMesh one = measure(1);
  const ObjectMesh three = measure(3);
  EXPECT_EQ(one.mesh.positions, three.mesh.positions);
  EXPECT_EQ(one.mesh.triangles, three.mesh.triangles);
  EXPECT_EQ(one.confidence, three.confidence);
}

}  // namespace
}  // namespace sheen::reconstruction
