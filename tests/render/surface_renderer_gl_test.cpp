// SPDX-License-Identifier: MIT
// The OpenGL renderer against the ray-cast reference, and the laws both must keep.
#include "render/surface/surface_renderer.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <iostream>
#include <string>
#include <tuple>

namespace sheen::render {
namespace {

using fitting::iwls::Layout;
using testing::Difference;

constexpr int kWidth = 320;
constexpr int kHeight = 240;

struct Pair {
  RenderedView gpu;
  RenderedView cpu;
};

Pair render_both(const core::Mesh& mesh, const fitting::PatchLightField& light_field,
                 const core::CameraModel& camera, const Eigen::Isometry3d& pose) {
  const auto context = make_osmesa_context();
  const auto gpu = make_gl_surface_renderer(*context, mesh, light_field);
  const auto cpu = make_reference_surface_renderer(mesh, light_field, 1);
  return {gpu->render(camera, pose), cpu->render(camera, pose)};
}

/// GPU and CPU within one step in the mean and for 99.9 % of the values on interior pixels; masks
/// alike up to the pixels whose centres an edge passes within rounding. `largest` is allowed at
/// single pixels: a distorted edge may be 0.05 px off, and random colours change by up to 80 steps
/// per pixel where triangles are seen from the side.
void expect_equal(const Pair& views, const std::string& what, int largest) {
  const cv::Mat interior = testing::common_interior(views.gpu.mask, views.cpu.mask, 1);
  const Difference found = testing::difference(views.gpu.image, views.cpu.image, interior);
  const int mask_difference = cv::countNonZero(views.gpu.mask != views.cpu.mask);
  const int support_difference = cv::countNonZero(views.gpu.support != views.cpu.support);
  std::cout << what << ": mean " << found.mean << " q99.9 " << found.quantile_999 << " max "
            << found.largest << " over " << found.pixels << " pixels, mask " << mask_difference
            << ", support " << support_difference << "\n";
  EXPECT_GT(found.pixels, 5000u);
  EXPECT_LE(found.mean, 1.0);
  EXPECT_LE(found.quantile_999, 1.0);
  EXPECT_LE(found.largest, largest);
  EXPECT_LE(mask_difference, 10);
  EXPECT_LE(support_difference, 20);
}

class IwlsAgreement : public ::testing::TestWithParam<std::tuple<Layout, int, int, bool>> {};

TEST_P(IwlsAgreement, GpuEqualsReference) {
  const auto [layout, centers, terms, distorted] = GetParam();
  const core::Mesh mesh = testing::sphere(0.1f, 20);
  // Between two unseen corners the colour jumps within a thousandth of a triangle, so that the
  // hundredths of a pixel by which a distorted edge is off show: unseen patches only without a
  // lens.
  const int unseen_every = distorted ? 0 : 5;
  const auto model =
      testing::random_iwls(layout, centers, terms, mesh.positions.size(), unseen_every);
  const core::CameraModel camera = distorted ? testing::distorted_camera(kWidth, kHeight)
                                             : testing::plain_camera(kWidth, kHeight);
  const Pair views =
      render_both(mesh, model, camera, testing::looking_at_origin({1, 0.4, 0.5}, 0.36));
  expect_equal(views, "iwls", distorted ? 4 : 1);
}

INSTANTIATE_TEST_SUITE_P(AllShapes, IwlsAgreement,
                         ::testing::Combine(::testing::Values(Layout::grid, Layout::jittered_grid,
                                                              Layout::disk, Layout::jittered_disk),
                                            ::testing::Values(16, 64), ::testing::Values(1, 3, 6),
                                            ::testing::Bool()));

// Both at once: the mean and the quantile hold, single pixels at those jumps do not.
TEST(SurfaceRenderer, UnseenPatchesUnderDistortion) {
  const core::Mesh mesh = testing::sphere(0.1f, 20);
  const auto model = testing::random_iwls(Layout::grid, 16, 3, mesh.positions.size(), 5);
  expect_equal(render_both(mesh, model, testing::distorted_camera(kWidth, kHeight),
                           testing::looking_at_origin({1, 0.4, 0.5}, 0.36)),
               "unseen, distorted", 100);
}

class MeanAgreement : public ::testing::TestWithParam<bool> {};

TEST_P(MeanAgreement, GpuEqualsReference) {
  const core::Mesh mesh = testing::sphere(0.1f, 20);
  const auto model = testing::random_mean(mesh.positions.size(), GetParam() ? 0 : 5);
  const core::CameraModel camera = GetParam() ? testing::distorted_camera(kWidth, kHeight)
                                              : testing::plain_camera(kWidth, kHeight);
  expect_equal(render_both(mesh, model, camera, testing::looking_at_origin({-0.3, 1, 0.2}, 0.36)),
               "mean", 2);
}

INSTANTIATE_TEST_SUITE_P(PlainAndDistorted, MeanAgreement, ::testing::Bool());

// Four triangles that fill the image: without tessellation the lens would bend their edges by
// several pixels.
TEST(SurfaceRenderer, CoarsestMeshUnderDistortion) {
  const core::Mesh mesh = testing::tetrahedron(0.2f);
  const auto model = testing::random_iwls(Layout::grid, 16, 3, mesh.positions.size(), 0);
  expect_equal(render_both(mesh, model, testing::distorted_camera(640, 480),
                           testing::looking_at_origin({1, 0.2, 0.3}, 0.45)),
               "tetrahedron", 2);
}

TEST(SurfaceRenderer, FineMesh) {
  const core::Mesh mesh = testing::sphere(0.1f, 123);
  ASSERT_GT(mesh.positions.size(), 30000u);
  const auto model = testing::smooth_iwls(mesh, 16, 3);
  expect_equal(render_both(mesh, model, testing::distorted_camera(640, 480),
                           testing::looking_at_origin({1, 0.2, 0.3}, 0.36)),
               "30k", 2);
}

// A camera amid the mesh: triangles cross the near plane and lie behind the camera.
TEST(SurfaceRenderer, CameraCloseToSurface) {
  const core::Mesh mesh = testing::tetrahedron(0.2f);
  const auto model = testing::random_mean(mesh.positions.size(), 0);
  Eigen::Isometry3d pose = testing::looking_at_origin({1, 0.2, 0.3}, 0.13);
  pose.prerotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()));
  pose.pretranslate(Eigen::Vector3d(0.02, 0.01, 0));
  expect_equal(render_both(mesh, model, testing::distorted_camera(kWidth, kHeight), pose), "close",
               2);
}

// A strong barrel polynomial turns back inside the image: no ray reaches the corners. Both
// renderers must leave them black and agree elsewhere.
TEST(SurfaceRenderer, LensThatFoldsBack) {
  core::CameraModel::Intrinsics in = testing::plain_camera(kWidth, kHeight).intrinsics();
  in.focal_px = {200, 200};
  in.distortion = {-0.4, 0, 0, 0, 0, 0, 0, 0};
  const core::CameraModel camera(in);
  // r (1 - 0.4 r^2) grows up to r = 1 / sqrt(1.2) = 0.913, where it is 0.609: 122 pixels of 200.
  const core::Mesh mesh = testing::sphere(1.0f, 40);
  const auto model = testing::smooth_iwls(mesh, 16, 3);
  const Pair views =
      render_both(mesh, model, camera, testing::looking_at_origin({1, 0.2, 0.3}, 1.3));
  EXPECT_EQ(views.gpu.mask.at<std::uint8_t>(0, 0), 0);
  EXPECT_EQ(views.gpu.mask.at<std::uint8_t>(kHeight / 2, 10), 0);
  EXPECT_EQ(views.gpu.mask.at<std::uint8_t>(kHeight / 2, kWidth / 2), 255);
  expect_equal(views, "folding lens", 2);
}

// A constant light field is a constant image: the weights cancel (eq. 7), whatever they are.
// 0.4 as half is 0.39990, times 255 is 101.97: every pixel 102; likewise 0.8 -> 0.7998 -> 203.94,
// 0.2 -> 0.19995 -> 50.99.
TEST(SurfaceRenderer, ConstantLightFieldGivesConstantImage) {
  const core::Mesh mesh = testing::sphere(0.1f, 12);
  auto model = testing::random_iwls(Layout::jittered_disk, 64, 6, mesh.positions.size(), 3);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    model.store_constant(i, {0.4f, 0.8f, 0.2f});
  const Pair views = render_both(mesh, model, testing::distorted_camera(kWidth, kHeight),
                                 testing::looking_at_origin({1, 1, 1}, 0.36));
  const auto expected = [](const cv::Mat& mask) {
    cv::Mat image(mask.size(), CV_8UC3, cv::Scalar(0, 0, 0));
    image.setTo(cv::Scalar(51, 204, 102), mask);  // BGR
    return image;
  };
  EXPECT_GT(cv::countNonZero(views.cpu.mask), 5000);
  EXPECT_EQ(cv::norm(views.cpu.image, expected(views.cpu.mask), cv::NORM_INF), 0);
  // A rasteriser's attributes carry about 2^-24 of their value at the image's origin, hundreds of
  // pixels of gradient away: near an unseen patch, whose sums are a thousandth of its neighbours',
  // that is 0.2 % of the ratio or half a step.
  EXPECT_LE(cv::norm(views.gpu.image, expected(views.gpu.mask), cv::NORM_INF), 1);
  EXPECT_LE(testing::difference(views.gpu.image, expected(views.gpu.mask), views.gpu.mask).mean,
            0.001);
}

// One corner seen (blue), two not (green): along a triangle the colour is
// (b * 1 * blue + (1 - b) / 1024 * green) / (b + (1 - b) / 1024). With b = 1/3 the share of green
// is (2/3/1024) / (1/3 + 2/3/1024) = 0.00195, half a step of 255: the seen colour decides.
TEST(SurfaceRenderer, UnseenVertexTakesTheColourOfASeenOne) {
  core::Mesh mesh;
  mesh.positions = {{0, 0, 0.1f}, {0, -0.1f, -0.1f}, {0, 0.1f, -0.1f}};
  mesh.normals.assign(3, Eigen::Vector3f::UnitX());
  mesh.triangles = {Eigen::Vector3i(0, 1, 2).cast<std::uint32_t>()};
  fitting::mean::MeanLightField model(3);
  model.store(0, {0, 0, 1}, true);
  model.store(1, {0, 1, 0}, false);
  model.store(2, {0, 1, 0}, false);
  const Pair views = render_both(mesh, model, testing::plain_camera(kWidth, kHeight),
                                 testing::looking_at_origin({1, 0, 0}, 0.5));
  for (const RenderedView& view : {views.gpu, views.cpu}) {
    // The centroid lies at z = -0.033: 1.25 * 320 * 0.0333 / 0.5 = 26.7 pixels below the centre.
    const auto centroid = view.image.at<cv::Vec3b>(kHeight / 2 + 26, kWidth / 2);
    EXPECT_GE(centroid[0], 254);
    EXPECT_LE(centroid[1], 1);
    EXPECT_EQ(view.support.at<std::uint8_t>(kHeight / 2 + 26, kWidth / 2), 255);
  }
}

TEST(SurfaceRenderer, NothingObservedIsDrawnWithoutSupport) {
  const core::Mesh mesh = testing::tetrahedron(0.1f);
  const fitting::mean::MeanLightField model(mesh.positions.size());
  const Pair views = render_both(mesh, model, testing::plain_camera(kWidth, kHeight),
                                 testing::looking_at_origin({1, 0, 0.1}, 0.5));
  for (const RenderedView& view : {views.gpu, views.cpu}) {
    EXPECT_GT(cv::countNonZero(view.mask), 1000);
    EXPECT_EQ(cv::countNonZero(view.support), 0);
  }
}

// Back faces are no surface: from inside a closed mesh nothing is seen.
TEST(SurfaceRenderer, BackFacesAreNotDrawn) {
  const core::Mesh mesh = testing::sphere(1.0f, 12);
  const auto model = testing::random_mean(mesh.positions.size(), 0);
  const Pair views = render_both(mesh, model, testing::plain_camera(kWidth, kHeight),
                                 testing::looking_at_origin({1, 0, 0}, 0.1));
  EXPECT_EQ(cv::countNonZero(views.gpu.mask), 0);
  EXPECT_EQ(cv::countNonZero(views.cpu.mask), 0);
}

TEST(SurfaceRenderer, ReferenceDoesNotDependOnThreads) {
  const core::Mesh mesh = testing::sphere(0.1f, 20);
  const auto model = testing::random_iwls(Layout::disk, 16, 3, mesh.positions.size(), 4);
  const auto camera = testing::distorted_camera(kWidth, kHeight);
  const auto pose = testing::looking_at_origin({1, 0.4, 0.5}, 0.36);
  const RenderedView one = make_reference_surface_renderer(mesh, model, 1)->render(camera, pose);
  const RenderedView three = make_reference_surface_renderer(mesh, model, 3)->render(camera, pose);
  EXPECT_EQ(cv::norm(one.image, three.image, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(one.mask, three.mask, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(one.support, three.support, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace sheen::render
