// SPDX-License-Identifier: MIT
// The shader of sparse patches against the reference renderer, which calls LightField::evaluate.
#include "render/surface/patch_shader.h"
#include "render/surface/surface_renderer.h"
#include "tests/fitting/sparse_models_for_tests.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <array>
#include <iostream>

namespace sheen::render {
namespace {

using fitting::sparse::kMaxRbfs;
using fitting::sparse::PatchModel;
using fitting::testing::random_patch;
using fitting::testing::random_sparse;

constexpr unsigned kSeed = 815;

class SparseAgreement : public ::testing::TestWithParam<std::size_t> {};

// Same formula, same halves, float on both sides: one step of 1/255 on interior pixels.
TEST_P(SparseAgreement, GpuEqualsReference) {
  const core::Mesh mesh = testing::sphere(0.1f, 20);
  const auto model = random_sparse(mesh.positions.size(), GetParam(), 5, kSeed);
  const auto camera = testing::plain_camera(320, 240);
  const auto pose = testing::looking_at_origin({1, 0.4, 0.5}, 0.36);
  const auto context = make_osmesa_context();
  const RenderedView gpu = make_gl_surface_renderer(*context, mesh, model)->render(camera, pose);
  const RenderedView cpu = make_reference_surface_renderer(mesh, model, 1)->render(camera, pose);
  const cv::Mat interior = testing::common_interior(gpu.mask, cpu.mask, 1);
  const testing::Difference found = testing::difference(gpu.image, cpu.image, interior);
  std::cout << "at most " << GetParam() << " RBFs: mean " << found.mean << " max " << found.largest
            << " over " << found.pixels << " pixels, seed " << kSeed << "\n";
  EXPECT_GT(found.pixels, 5000u);
  EXPECT_LE(found.largest, 1);
}

INSTANTIATE_TEST_SUITE_P(RbfCounts, SparseAgreement,
                         ::testing::Values(std::size_t{0}, std::size_t{5}, kMaxRbfs));

// Four halfs per texel, and as many texels as the largest patch needs, in steps of four: one for
// constants, 1 + 3 + 2 -> 8 for two RBFs on a linear base, 28 at most.
TEST(SparsePatchShader, SendsWhatTheLargestPatchNeeds) {
  const auto context = make_osmesa_context();
  const gl::Functions gl = gl::load_functions(*context);
  fitting::sparse::LightFieldModel model(10);
  const auto shader = make_patch_shader(gl, model);
  const std::array<std::uint32_t, 2> two{3, 9};
  EXPECT_EQ(shader->upload(two), 2u * 1u * 8u);
  // A patch outgrows the buffer: everything goes over.
  PatchModel patch;
  patch.base_terms = fitting::sparse::kLinearBase;
  patch.rbf_count = 2;
  patch.atom[0] = 4;
  patch.atom[1] = 44;
  patch.coefficient.fill(Eigen::Vector3f::Constant(0.1f));
  model.store(9, patch);
  EXPECT_EQ(shader->upload(two), 10u * 8u * 8u);
  // From then on only what changed.
  EXPECT_EQ(shader->upload(two), 2u * 8u * 8u);
  // The largest patch there is.
  patch.rbf_count = kMaxRbfs;
  for (std::size_t i = 0; i < kMaxRbfs; ++i) patch.atom[i] = static_cast<std::uint16_t>(3 * i);
  model.store(3, patch);
  EXPECT_EQ(shader->upload(two), 10u * 28u * 8u);
  EXPECT_EQ(shader->upload({}), 0u);
}

// Growing patch by patch shows the same image as a renderer made for the final model.
TEST(SparsePatchShader, GrowingEqualsStartingAfresh) {
  const core::Mesh mesh = testing::sphere(0.1f, 16);
  fitting::sparse::LightFieldModel model(mesh.positions.size());
  const auto camera = testing::plain_camera(160, 120);
  const auto pose = testing::looking_at_origin({1, 0.4, 0.5}, 0.36);
  const auto context = make_osmesa_context();
  const auto renderer = make_gl_surface_renderer(*context, mesh, model);
  const cv::Mat grey = renderer->render(camera, pose).image;
  std::mt19937 random(kSeed);
  for (const std::size_t most_rbfs : {std::size_t{0}, std::size_t{3}, std::size_t{20}}) {
    // Change every third patch; the others keep what they have.
    std::vector<std::uint32_t> written;
    for (std::uint32_t i = 0; i < model.patch_count(); i += 3) {
      model.store(i, random_patch(random, most_rbfs));
      model.store_observed(i, i % 2 == 0);
      written.push_back(i);
    }
    renderer->upload(written);
    const cv::Mat grown = renderer->render(camera, pose).image;
    const cv::Mat fresh =
        make_gl_surface_renderer(*context, mesh, model)->render(camera, pose).image;
    EXPECT_EQ(cv::norm(grown, fresh, cv::NORM_INF), 0) << most_rbfs;
    EXPECT_GT(cv::norm(grown, grey, cv::NORM_INF), 20) << most_rbfs;
  }
}

}  // namespace
}  // namespace sheen::render
