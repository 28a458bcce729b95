// SPDX-License-Identifier: MIT
// Which pixels see a mesh does not depend on what is painted on it.
#include "render/surface/object_mask.h"
#include "render/surface/surface_renderer.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <vector>

namespace sheen::render {
namespace {

using fitting::iwls::Layout;

constexpr int kMaskWidth = 320;
constexpr int kMaskHeight = 240;

TEST(ObjectMask, EqualsTheMaskOfTheMeshsOwnRenderer) {
  const auto context = make_osmesa_context();
  const std::vector<core::Mesh> meshes{
      testing::sphere(0.1f, 20), testing::torus_knot(0.2f, 240, 20), testing::tetrahedron(0.2f)};
  const std::vector<core::CameraModel> cameras{testing::plain_camera(kMaskWidth, kMaskHeight),
                                               testing::distorted_camera(kMaskWidth, kMaskHeight)};
  for (const core::Mesh& mesh : meshes) {
    // Some patches are unseen: what nobody has seen is there all the same.
    const auto model = testing::random_iwls(Layout::disk, 16, 3, mesh.positions.size(), 4);
    const auto renderer = make_renderer(*context, mesh, model);
    const auto reference = make_reference_surface_renderer(mesh, model, 1);
    ObjectMask object(*context, mesh);
    // One mask for several cameras and places, as an evaluation uses it.
    for (const core::CameraModel& camera : cameras) {
      for (const Eigen::Vector3d& from :
           {Eigen::Vector3d(1, 0.4, 0.5), Eigen::Vector3d(-0.3, 1, -0.2)}) {
        const auto pose = testing::looking_at_origin(from, 0.45);
        const cv::Mat mask = object.seen_by(camera, pose);
        ASSERT_EQ(mask.type(), CV_8UC1);
        ASSERT_EQ(mask.size(), cv::Size(kMaskWidth, kMaskHeight));
        EXPECT_EQ(cv::countNonZero(mask != renderer->render(camera, pose).mask), 0);
        // Rays decide pixels whose centres an edge passes within rounding for themselves.
        EXPECT_LE(cv::countNonZero(mask != reference->render(camera, pose).mask), 10);
        EXPECT_GT(cv::countNonZero(mask), 2000);
        EXPECT_EQ(cv::countNonZero(mask) + cv::countNonZero(mask == 0), kMaskWidth * kMaskHeight);
        EXPECT_EQ(cv::countNonZero(mask == 255), cv::countNonZero(mask));
      }
    }
  }
}

}  // namespace
}  // namespace sheen::render
