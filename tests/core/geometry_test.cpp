// SPDX-License-Identifier: MIT
#include "core/geometry/camera.h"
#include "core/geometry/disc_map.h"
#include "core/geometry/tangent_frame.h"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include <cmath>
#include <numbers>
#include <random>

namespace sheen::core {
namespace {

constexpr unsigned kSeed = 20240607;

class Geometry : public ::testing::Test {
 protected:
  void SetUp() override { RecordProperty("seed", static_cast<int>(kSeed)); }
  float uniform() { return std::uniform_real_distribution<float>(-1.0f, 1.0f)(random_); }
  Eigen::Vector3f unit_vector() {
    std::normal_distribution<float> normal;
    return Eigen::Vector3f(normal(random_), normal(random_), normal(random_)).normalized();
  }
  std::mt19937 random_{kSeed};
};

using DiscMap = Geometry;
using Frame = Geometry;
using Camera = Geometry;

TEST_F(DiscMap, SquareAfterDiscIsIdentity) {
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector2f ab(uniform(), uniform());
    // A handful of roundings of numbers up to 1, the angle's multiplied by 4 / pi: 16 eps = 1.9e-6.
    EXPECT_LT((square_from_disc(disc_from_square(ab)) - ab).cwiseAbs().maxCoeff(), 2e-6f)
        << ab.transpose();
  }
}

TEST_F(DiscMap, DiscAfterSquareIsIdentity) {
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector2f uv = disc_from_hemisphere(unit_vector());
    EXPECT_LT((disc_from_square(square_from_disc(uv)) - uv).norm(), 2e-6f) << uv.transpose();
  }
}

TEST_F(DiscMap, RingsBecomeCircles) {
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2f ab(uniform(), uniform());
    // The map keeps the ring: |disc| = max(|a|, |b|). Two roundings.
    EXPECT_NEAR(disc_from_square(ab).norm(), ab.cwiseAbs().maxCoeff(), 3e-7f);
  }
}

TEST_F(DiscMap, KeepsAreas) {
  constexpr float h = 1e-2f;
  int tried = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2f ab(uniform() * 0.95f, uniform() * 0.95f);
    // Differences must not straddle a diagonal, where the map is continuous but has a kink.
    const float from_diagonal = std::abs(std::abs(ab.x()) - std::abs(ab.y()));
    if (from_diagonal < 3 * h || ab.cwiseAbs().maxCoeff() < 0.3f) continue;
    const Eigen::Vector2f dx(h, 0);
    const Eigen::Vector2f dy(0, h);
    const Eigen::Vector2f da = (disc_from_square(ab + dx) - disc_from_square(ab - dx)) / (2 * h);
    const Eigen::Vector2f db = (disc_from_square(ab + dy) - disc_from_square(ab - dy)) / (2 * h);
    // Disc area / square area = pi / 4 everywhere. In a wedge the third derivatives are below
    // r (pi/4)^3 (2/r)^3 < 45, so central differences err by h^2 / 6 * 45 < 1e-3 each.
    EXPECT_NEAR(std::abs(da.x() * db.y() - da.y() * db.x()), std::numbers::pi_v<float> / 4, 2e-3f)
        << ab.transpose();
    ++tried;
  }
  EXPECT_GT(tried, 1000);
}

TEST_F(DiscMap, HemisphereAfterDiscIsIdentity) {
  for (int i = 0; i < 10000; ++i) {
    Eigen::Vector3f direction = unit_vector();
    direction.z() = std::abs(direction.z());
    const Eigen::Vector3f back = hemisphere_from_disc(disc_from_hemisphere(direction));
    EXPECT_EQ(back.head<2>(), direction.head<2>());
    // z = sqrt(1 - r^2): an error of 4 eps under the root grows to 4 eps / (2 z), at the rim to
    // sqrt(4 eps).
    EXPECT_NEAR(back.z(), direction.z(), std::min(7e-4f, 5e-7f / direction.z()));
  }
}

TEST_F(DiscMap, OutsideGoesToTheRim) {
  const Eigen::Vector3f rim = hemisphere_from_disc({3, 4});
  EXPECT_LT((rim - Eigen::Vector3f(0.6f, 0.8f, 0.0f)).norm(), 1e-7f);
}

TEST_F(Frame, IsOrthonormalAndRightHanded) {
  std::vector<Eigen::Vector3f> normals = {{0, 0, 1}, {0, 0, -1}, {0, 0.6f, -0.8f}, {1, 0, 0}};
  for (int i = 0; i < 10000; ++i) normals.push_back(unit_vector());
  for (const Eigen::Vector3f& n : normals) {
    const TangentFrame frame = tangent_frame(n);
    EXPECT_NEAR(frame.tangent.norm(), 1, 1e-6) << n.transpose();
    EXPECT_NEAR(frame.bitangent.norm(), 1, 1e-6) << n.transpose();
    EXPECT_NEAR(frame.tangent.dot(frame.bitangent), 0, 1e-6) << n.transpose();
    EXPECT_LT((frame.tangent.cross(frame.bitangent) - n).norm(), 1e-6f) << n.transpose();
  }
}

TEST_F(Frame, DirectionIsTheUnitVectorInTheFrame) {
  for (int i = 0; i < 1000; ++i) {
    const TangentFrame frame = tangent_frame(unit_vector());
    const Eigen::Vector3f position = unit_vector();
    const Eigen::Vector3f w = unit_vector();
    const DiscDirection direction = direction_towards(frame, position, position + 2 * w);
    const Eigen::Vector3f back = direction.uv.x() * frame.tangent +
                                 direction.uv.y() * frame.bitangent +
                                 direction.cosine * frame.normal;
    EXPECT_LT((back - w).norm(), 1e-6f);
  }
}

CameraModel rational_camera(std::array<double, 8> distortion) {
  return CameraModel({640, 480, {611.5, 609.25}, {318.75, 242.5}, distortion});
}

const std::vector<std::array<double, 8>> kDistortions = {{-0.28, 0.07, 1e-3, -5e-4},
                                                    {0.12, -0.25, -7e-4, 4e-4, 0.11},
                                                    {0.5, -0.1, 1e-3, 2e-4, 0.02, 0.6, -0.08, 0.01},
                                                    {}};

TEST_F(Camera, AgreesWithOpenCv) {
  for (const auto& lens : kDistortions) {
    const CameraModel camera = rational_camera(lens);
    const cv::Matx33d K(611.5, 0, 318.75, 0, 609.25, 242.5, 0, 0, 1);
    const cv::Vec<double, 8> distortion(lens.data());
    std::vector<cv::Point3d> points;
    for (int i = 0; i < 1000; ++i) {
      const double z = 1.5 + static_cast<double>(uniform());
      points.emplace_back(0.4 * z * static_cast<double>(uniform()),
                          0.3 * z * static_cast<double>(uniform()), z);
    }
    std::vector<cv::Point2d> expected;
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), K, distortion, expected);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto pixel = camera.project({points[i].x, points[i].y, points[i].z});
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(pixel->x(), expected[i].x, 1e-9);
      EXPECT_NEAR(pixel->y(), expected[i].y, 1e-9);
    }
  }
}

TEST_F(Camera, ProjectAfterUnprojectIsIdentity) {
  for (const auto& lens : kDistortions) {
    const CameraModel camera = rational_camera(lens);
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector2d pixel(319.5 + 320 * static_cast<double>(uniform()),
                                  239.5 + 240 * static_cast<double>(uniform()));
      const auto ray = camera.unproject(pixel);
      ASSERT_TRUE(ray) << pixel.transpose();
      EXPECT_EQ(ray->z(), 1);
      const auto back = camera.project(*ray * 0.7);
      ASSERT_TRUE(back);
      // Newton stops at 1e-8 in the plane z = 1 or better: 611.5 * 1e-8 = 6e-6 px.
      EXPECT_LT((*back - pixel).norm(), 1e-5) << pixel.transpose();
    }
  }
}

TEST_F(Camera, RefusesWhatTheLensPolynomialFoldsBack) {
  const double k1 = 0.195;
  const double k2 = -0.609;
  const CameraModel camera = rational_camera({k1, k2});
  // d/dr r (1 + k1 r^2 + k2 r^4) = 0 at 5 k2 r^4 + 3 k1 r^2 + 1 = 0: r = 0.823; searched in steps
  // of 0.002.
  const double fold = std::sqrt((-3 * k1 - std::sqrt(9 * k1 * k1 - 20 * k2)) / (10 * k2));
  EXPECT_NEAR(camera.valid_radius(), fold, 0.002);
  // The polynomial vanishes at k2 r^4 + k1 r^2 + 1 = 0: r = 1.205. OpenCV puts this point, 50
  // degrees off the axis, on the principal point.
  const double r = std::sqrt((-k1 - std::sqrt(k1 * k1 - 4 * k2)) / (2 * k2));
  EXPECT_LT(camera.distort({r, 0}).norm(), 1e-12);
  EXPECT_FALSE(camera.project({r, 0, 1}));
  EXPECT_TRUE(camera.project({fold - 0.003, 0, 1}));
  EXPECT_FALSE(camera.project({fold + 0.003, 0, 1}));
}

TEST_F(Camera, UnprojectsNothingWhereTheLensReachesNot) {
  // The largest distorted radius of this lens is 0.823 (1 + 0.195 * 0.677 - 0.609 * 0.458) = 0.702.
  const CameraModel camera = rational_camera({0.195, -0.609});
  EXPECT_TRUE(camera.unproject({318.75 + 611.5 * 0.69, 242.5}));
  EXPECT_FALSE(camera.unproject({318.75 + 611.5 * 0.75, 242.5}));
}

TEST_F(Camera, SeesNothingBehindItself) {
  const CameraModel camera = rational_camera({});
  EXPECT_FALSE(camera.project({0, 0, -1}));
  EXPECT_FALSE(camera.project({0, 0, 0}));
  EXPECT_FALSE(camera.project({std::nan(""), 0, 1}));
}

}  // namespace
}  // namespace sheen::core
