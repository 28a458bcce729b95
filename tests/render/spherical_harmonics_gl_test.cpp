// SPDX-License-Identifier: MIT
// The shader of spherical harmonics against the reference renderer.
#include "fitting/spherical_harmonics/light_field_model.h"
#include "render/surface/patch_shader.h"
#include "render/surface/surface_renderer.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <array>
#include <iostream>
#include <random>

namespace sheen::render {
namespace {

using fitting::spherical_harmonics::LightFieldModel;
using fitting::spherical_harmonics::term_count;

constexpr unsigned kSeed = 314;

// Constants in [0.3, 0.7], the others in [-0.15, 0.15]; every fifth patch unseen.
LightFieldModel random_model(int degree, std::size_t patch_count) {
  std::mt19937 random(kSeed);
  LightFieldModel model(degree, patch_count);
  std::vector<double> values(3 * term_count(degree));
  for (std::size_t patch = 0; patch < patch_count; ++patch) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double unit = static_cast<double>(random()) / 4294967296.0;
      values[i] =
          i < 3 ? (0.3 + 0.4 * unit) / fitting::spherical_harmonics::kY00 : 0.3 * unit - 0.15;
    }
    model.store(patch, values);
    model.store_observed(patch, patch % 5 != 0);
  }
  return model;
}

class HarmonicsAgreement : public ::testing::TestWithParam<int> {};

// Same formula, same halves, float on both sides: one step of 1/255 on interior pixels.
TEST_P(HarmonicsAgreement, GpuEqualsReference) {
  const core::Mesh mesh = testing::sphere(0.1f, 20);
  const LightFieldModel model = random_model(GetParam(), mesh.positions.size());
  const auto camera = testing::plain_camera(320, 240);
  const auto pose = testing::looking_at_origin({1, 0.4, 0.5}, 0.36);
  const auto context = make_osmesa_context();
  const RenderedView gpu = make_gl_surface_renderer(*context, mesh, model)->render(camera, pose);
  const RenderedView cpu = make_reference_surface_renderer(mesh, model, 1)->render(camera, pose);
  const cv::Mat interior = testing::common_interior(gpu.mask, cpu.mask, 1);
  const testing::Difference found = testing::difference(gpu.image, cpu.image, interior);
  std::cout << "degree " << GetParam() << ": mean " << found.mean << " max " << found.largest
            << " over " << found.pixels << " pixels, seed " << kSeed << "\n";
  EXPECT_GT(found.pixels, 5000u);
  EXPECT_LE(found.largest, 1);
}

INSTANTIATE_TEST_SUITE_P(Degrees, HarmonicsAgreement, ::testing::Values(1, 2, 3));

// Eight bytes per term: 4, 9 and 16 terms.
TEST_P(HarmonicsAgreement, SendsOneTexelPerTerm) {
  const auto context = make_osmesa_context();
  const gl::Functions gl = gl::load_functions(*context);
  const LightFieldModel model(GetParam(), 10);
  const auto terms = static_cast<std::size_t>((GetParam() + 1) * (GetParam() + 1));
  EXPECT_EQ(make_patch_shader(gl, model)->upload(std::array<std::uint32_t, 2>{3, 9}),
            2 * 8 * terms);
}

}  // namespace
}  // namespace sheen::render
