// SPDX-License-Identifier: MIT
// Images that were looked at once and must stay as they are: tests/render/golden.
#include "render/surface/surface_renderer.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <filesystem>
#include <string>

namespace sheen::render {
namespace {

/// Compares with golden/NAME.png; differences in steps of 1/255, the mean over the whole image,
/// the largest one pixel inside the silhouette, where no driver may decide otherwise. A failure
/// leaves NAME_actual.png and NAME_difference.png (amplified) in the working directory.
void expect_golden(const RenderedView& view, const std::string& name, double mean, int largest) {
  const cv::Mat& image = view.image;
  const std::filesystem::path folder = SHEEN_SOURCE_DIR "/tests/render/golden";
  const cv::Mat golden = cv::imread((folder / (name + ".png")).string(), cv::IMREAD_COLOR);
  const bool same_size = golden.size() == image.size();
  const cv::Mat everywhere(image.size(), CV_8UC1, cv::Scalar(255));
  double found_mean = 0;
  int found_largest = 0;
  if (same_size) {
    const cv::Mat interior = testing::common_interior(view.mask, view.mask, 1);
    found_mean = testing::difference(image, golden, everywhere).mean;
    found_largest = testing::difference(image, golden, interior).largest;
    if (found_mean <= mean && found_largest <= largest) return;
  }

  // Leave what is needed to judge.
  cv::imwrite(name + "_actual.png", image);
  if (same_size) {
    cv::Mat amplified;
    cv::absdiff(image, golden, amplified);
    cv::imwrite(name + "_difference.png", amplified * 16);
  }
  ADD_FAILURE() << name << ": mean difference " << found_mean << " (allowed " << mean
                << "), largest " << found_largest << " (allowed " << largest << "), "
                << (same_size ? "sizes alike" : "golden image missing or of another size")
                << "; see " << name << "_actual.png and " << name << "_difference.png in "
                << std::filesystem::current_path();
}

RenderedView draw(const core::Mesh& mesh, const fitting::PatchLightField& light_field,
                  const core::CameraModel& camera, const Eigen::Isometry3d& pose) {
  const auto context = make_osmesa_context();
  return make_gl_surface_renderer(*context, mesh, light_field)->render(camera, pose);
}

// Allowed in the mean: eight silhouette pixels of 19200 may fall to the other side in another
// driver (120 steps each), everything else keeps within rounding.
TEST(Golden, GlossyTorusKnot) {
  const core::Mesh mesh = testing::torus_knot(0.2f, 240, 20);
  const auto model = testing::smooth_iwls(mesh, 16, 3);
  expect_golden(draw(mesh, model, testing::plain_camera(160, 120),
                     testing::looking_at_origin({0.5, -0.6, 1}, 0.32)),
                "torus_knot", 0.05, 2);
}

TEST(Golden, TetrahedronThroughADistortingLens) {
  const core::Mesh mesh = testing::tetrahedron(0.2f);
  const auto model = testing::random_iwls(fitting::iwls::Layout::grid, 16, 3, 4, 0);
  expect_golden(draw(mesh, model, testing::distorted_camera(160, 120),
                     testing::looking_at_origin({1, 0.2, 0.3}, 0.45)),
                "tetrahedron_bent", 0.05, 2);
}

// Every fourth patch unseen: colours of the neighbours flow in.
TEST(Golden, SphereWithUnseenPatches) {
  const core::Mesh mesh = testing::sphere(0.1f, 10);
  const auto model = testing::random_mean(mesh.positions.size(), 4);
  expect_golden(draw(mesh, model, testing::plain_camera(160, 120),
                     testing::looking_at_origin({-0.3, 1, 0.4}, 0.36)),
                "sphere_unseen", 0.05, 2);
}

}  // namespace
}  // namespace sheen::render
