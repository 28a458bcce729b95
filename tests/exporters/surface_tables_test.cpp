// SPDX-License-Identifier: MIT
#include "exporters/viewer/surface_tables.h"

#include "core/geometry/tangent_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sheen::exporters::viewer {
namespace {

TEST(RoundedSurface, KeepsPositionsNormalsAndTheTangentFrame) {
  constexpr unsigned seed = 3;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::normal_distribution<float> gauss;
  core::Mesh mesh;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f direction(gauss(random), gauss(random), gauss(random));
    mesh.positions.push_back(0.1f * direction);
    mesh.normals.push_back(direction.normalized());
  }
  // Where the frame jumps: z of either sign, and both zeros.
  for (const float z : {0.0f, -0.0f, 1e-7f, -1e-7f}) {
    mesh.positions.emplace_back(0.05f, 0.05f, 0.05f);
    mesh.normals.push_back(Eigen::Vector3f(0.6f, 0.8f, z));
  }
  const core::Mesh rounded = rounded_surface(mesh);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& position : mesh.positions) box.extend(position);
  const float step = box.sizes().maxCoeff() / 65535.0f;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    // Half a step, and what single precision adds.
    EXPECT_LE((rounded.positions[i] - mesh.positions[i]).cwiseAbs().maxCoeff(), 0.51f * step);
    // Steps of 1 / 32767 on the octahedron, which a normal leaves by a factor of at most sqrt(3).
    EXPECT_LT((rounded.normals[i] - mesh.normals[i]).norm(), 1e-4f);
    EXPECT_NEAR(rounded.normals[i].norm(), 1.0f, 1e-6f);
    const auto before = core::tangent_frame(mesh.normals[i]);
    const auto after = core::tangent_frame(rounded.normals[i]);
    EXPECT_LT((before.tangent - after.tangent).norm(), 3e-4f) << mesh.normals[i].transpose();
    EXPECT_LT((before.bitangent - after.bitangent).norm(), 3e-4f) << mesh.normals[i].transpose();
  }
}

}  // namespace
}  // namespace sheen::exporters::viewer
