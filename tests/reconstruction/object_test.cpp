// SPDX-License-Identifier: MIT
// From images to a surface: a ball on a sheet, drawn ray by ray.
#include "core/diagnostics/error.h"
#include "reconstruction/object/object_mesh.h"
#include "reconstruction/surface/self_intersection.h"
#include "tests/reconstruction/stage_for_tests.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>

namespace sheen::reconstruction {
namespace {

constexpr double kBallRadius_m = 0.03;
const Eigen::Vector3d kBallCentre(0.005, -0.004, 0.032);

/// What a ray meets: how far, in lengths of its direction, and the colour there, BGR of 255.
struct Hit {
  double way;
  cv::Vec3d colour;
};
using Object =
    std::function<std::optional<Hit>(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction)>;
/// Light on the sheet, 1 in the open.
using Shade = std::function<double(const Eigen::Vector2d& place)>;

std::optional<Hit> meet_ball(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d from = eye - kBallCentre;
  const double a = direction.squaredNorm();
  const double b = from.dot(direction);
  const double root = b * b - a * (from.squaredNorm() - kBallRadius_m * kBallRadius_m);
  if (root < 0) return std::nullopt;
  const double way = (-b - std::sqrt(root)) / a;
  const Eigen::Vector3d normal = (eye + way * direction - kBallCentre) / kBallRadius_m;
  return Hit{way, cv::Vec3d(50, 70, 190) * (0.6 + 0.4 * normal.z())};
}

double no_shade(const Eigen::Vector2d& /*place*/) {
  return 1;
}

cv::Vec3d sheet_colour(const capture::Board& board, const Eigen::Vector2d& place) {
  for (const auto& [id, tag] : board.tags) {
    const Eigen::Vector2d from = place - tag.board_from_tag.translation().head<2>();
    if (from.cwiseAbs().maxCoeff() < 0.5 * tag.size_m) return {30, 30, 30};
  }
  return place.cwiseAbs().maxCoeff() < 0.15 ? cv::Vec3d(225, 225, 225) : cv::Vec3d(90, 110, 130);
}

/// Four rays a pixel.
cv::Mat draw(const core::CameraModel& camera, const capture::Board& board, const Object& object,
             const Shade& shade, const Eigen::Isometry3d& camera_from_board) {
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
        if (const auto hit = object(eye, direction)) {
          sum += hit->colour;
        } else {
          const double down = direction.z() < -1e-6 ? -eye.z() / direction.z() : 1e6;
          const Eigen::Vector2d place = (eye + down * direction).head<2>();
          sum += shade(place) * sheet_colour(board, place);
        }
      }
      for (int c = 0; c < 3; ++c) {
        image.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<std::uint8_t>(sum[c] / 4);
      }
    }
  }
  return image;
}

/// The object as view `index` finds it.
using Scene = std::function<Object(int index)>;

ObjectMesh measure_scene(int threads, const Scene& scene, const Shade& shade = no_shade) {
  const core::CameraModel camera = tests::small_camera(160, 120);
  const capture::Board board = tests::ring_board();
  std::vector<PosedImage> images;
  for (const double elevation : {20.0, 55.0}) {
    for (const auto& pose : tests::ring_of_poses(12, 0.4, elevation, {0, 0, 0.02})) {
      const int index = static_cast<int>(images.size());
      images.push_back({index, draw(camera, board, scene(index), shade, pose), pose});
    }
  }
  return measure_object("walk", camera, board, images, threads, [](std::string_view, int, int) {});
}

ObjectMesh measure(int threads, const Object& object = meet_ball, const Shade& shade = no_shade) {
  return measure_scene(
      threads, [&](int) { return object; }, shade);
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

/// Distance from a torus round the z axis whose tube of 10 mm lies on the sheet 30 mm from it, in
/// striped colours.
constexpr double kRing_m = 0.03;
constexpr double kTube_m = 0.01;

double from_torus(const Eigen::Vector3d& p) {
  return std::hypot(p.head<2>().norm() - kRing_m, p.z() - kTube_m) - kTube_m;
}

/// Steps along the ray as far as the distance allows.
std::optional<Hit> meet_torus(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d unit = direction.normalized();
  double way = 0.3;
  for (int step = 0; step < 60; ++step) {
    const Eigen::Vector3d p = eye + way * unit;
    const double distance = from_torus(p);
    if (distance < 1e-5) {
      const bool stripe = std::sin(9 * std::atan2(p.y(), p.x())) > 0;
      return Hit{way / direction.norm(), stripe ? cv::Vec3d(40, 60, 150) : cv::Vec3d(120, 90, 30)};
    }
    if (p.z() < 0 || distance > 0.2) return std::nullopt;
    way += distance;
  }
  return std::nullopt;
}

/// A ring keeps light from the sheet within and below it; half of what is in the open is left.
double shade_of_torus(const Eigen::Vector2d& place) {
  const double d = (place.norm() - kRing_m) / 0.02;
  return 1 - 0.5 * std::exp(-d * d);
}

TEST(MeasuredObject, HasTheOpeningOfATorus) {
  const ObjectMesh found = measure(1, meet_torus, shade_of_torus);
  EXPECT_TRUE(is_closed_manifold(found.mesh));
  // A torus has V - E + F = 0, a filled one 2; E = 3 F / 2 as triangles are closed up.
  EXPECT_EQ(static_cast<long>(found.mesh.positions.size()),
            static_cast<long>(found.mesh.triangles.size() / 2));
  // Views at 55 degrees see the sheet within the ring, less the shadowed side: nothing of the mesh
  // is left in the middle 10 mm of the 20 mm wide opening.
  double nearest = 1;
  for (const auto& p : found.mesh.positions) {
    nearest = std::min(nearest, static_cast<double>(p.head<2>().norm()));
  }
  EXPECT_GT(nearest, 0.010);
}

/// A box of 60 x 40 x 50 mm on the sheet, each face in a colour of its own.
std::optional<Hit> meet_box(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d low(-0.03, -0.02, 0);
  const Eigen::Vector3d high(0.03, 0.02, 0.05);
  double enter = 0;
  double leave = 10;
  int face = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double near = (low[axis] - eye[axis]) / direction[axis];
    double far = (high[axis] - eye[axis]) / direction[axis];
    if (near > far) std::swap(near, far);
    if (near > enter) {
      enter = near;
      face = 2 * axis + (direction[axis] > 0 ? 0 : 1);
    }
    leave = std::min(leave, far);
  }
  if (enter >= leave) return std::nullopt;
  constexpr std::array<std::array<double, 3>, 6> colours{
      {{40, 40, 160}, {40, 140, 40}, {160, 60, 40}, {30, 130, 150}, {60, 60, 60}, {120, 60, 120}}};
  const auto& c = colours[static_cast<std::size_t>(face)];
  return Hit{enter, {c[0], c[1], c[2]}};
}

TEST(MeasuredObject, HasFlatFacesAndSharpEdgesWhereItIsABox) {
  const ObjectMesh found = measure(1, meet_box);
  EXPECT_TRUE(is_closed_manifold(found.mesh));
  EXPECT_TRUE(find_self_intersections(found.mesh, 1).empty());
  // The long side y = 20 mm is seen edge on by no view: from (+-.4, 0) its tangents run through the
  // corners (+-30, 20) mm, so the hull reaches 20 * .4 / .37 = 21.6 mm in its middle. Outlines add
  // half a pixel of 2.3 mm.
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (const auto& p : found.mesh.positions) {
    if (std::abs(p.x()) > 0.02F || p.y() < 0.01F || p.z() < 0.01F || p.z() > 0.04F) continue;
    sum += static_cast<double>(p.y());
    squares += static_cast<double>(p.y()) * static_cast<double>(p.y());
    ++count;
  }
  ASSERT_GT(count, 50);
  const double mean = sum / count;
  const double ripple = std::sqrt(squares / count - mean * mean);
  EXPECT_GT(mean, 0.02 - 0.0012);
  EXPECT_LT(mean, 0.0216 + 0.0012);
  EXPECT_LT(ripple, 0.0006);  // a quarter of a pixel
}

/// The ball in the colour of the paper (225), a little darker below.
std::optional<Hit> meet_white_ball(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) {
  auto hit = meet_ball(eye, direction);
  if (!hit) return hit;
  const Eigen::Vector3d normal = (eye + hit->way * direction - kBallCentre) / kBallRadius_m;
  hit->colour = cv::Vec3d::all(225 * (0.95 + 0.05 * normal.z()));
  return hit;
}

/// The ball as if it stood elsewhere.
Object ball_moved_by(const Eigen::Vector3d& way) {
  return [way](const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) {
    return meet_ball(eye - way, direction);
  };
}

void expect_refused(const Scene& scene, const std::string& cause) {
  try {
    measure_scene(1, scene);
    FAIL() << "not refused: " << cause;
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("walk: " + cause), std::string::npos) << error.what();
  }
}

TEST(MeasuredObject, IsRefusedForWhatIsWrong) {
  expect_refused([](int) { return meet_white_ball; }, "the object looks like the sheet");
  expect_refused([](int) { return ball_moved_by({0.13, 0, 0}); }, "the object stands beside");
  // Half-way through somebody moves it by its own width.
  expect_refused(
      [](int index) {
        return ball_moved_by({0, index < 12 ? -0.03 : 0.03, 0});
      },
      "the object stands elsewhere in the second half");
  expect_refused(
      [](int) {
        return [](const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) {
          const auto one = ball_moved_by({0, -0.04, 0})(eye, direction);
          const auto other = ball_moved_by({0, 0.04, 0})(eye, direction);
          return one && (!other || one->way < other->way) ? one : other;
        };
      },
      "more than one object stands on the sheet");
}

}  // namespace
}  // namespace sheen::reconstruction
