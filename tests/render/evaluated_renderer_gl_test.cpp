// SPDX-License-Identifier: MIT
// Light fields without GLSL of their own: drawn from what the CPU evaluates.
#include "render/surface/surface_renderer.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <array>
#include <cmath>
#include <iostream>

namespace sheen::render {
namespace {

/// A look that no shader knows: stripes in direction space, their level differing by patch.
class StripedLightField final : public fitting::PatchLightField {
 public:
  /// Every `unseen_every`-th patch is unobserved (0: none).
  StripedLightField(std::size_t patch_count, std::size_t unseen_every) : observed_(patch_count, 1) {
    for (std::size_t i = 0; i < patch_count && unseen_every > 0; i += unseen_every) {
      observed_[i] = 0;
    }
  }
  [[nodiscard]] std::string_view representation() const override { return "stripes"; }
  [[nodiscard]] std::size_t patch_count() const override { return observed_.size(); }
  [[nodiscard]] fitting::WeightedColour evaluate(std::size_t patch_idx,
                                                 const Eigen::Vector2f& uv) const override {
    const float weight = observed_[patch_idx] != 0 ? 1.7f : fitting::kUnseenWeight;
    const float level = phase + 0.01f * static_cast<float>(patch_idx % 30);
    return {weight * Eigen::Vector3f(level, 0.5f + 0.3f * std::sin(6.0f * uv.x()),
                                     0.5f + 0.3f * std::cos(5.0f * uv.y())),
            weight};
  }
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t /*patch_idx*/) const override {
    return Eigen::Vector3f::Constant(0.5f);
  }
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override { return observed_; }
  [[nodiscard]] std::size_t coefficient_count() const override { return 0; }

  float phase = 0.2f;

 private:
  std::vector<std::uint8_t> observed_;
};

class EvaluatedAgreement : public ::testing::TestWithParam<std::size_t> {};

// Halves are within 2^-11 of the quotient, half a step of 1/255 would be 2^-9: one step on interior
// pixels, from every side. Between two unseen corners the colour jumps within a thousandth of a
// triangle, where a pixel's rounding shows: there 99.9 % of the values.
TEST_P(EvaluatedAgreement, EqualsReference) {
  const core::Mesh mesh = testing::sphere(0.1f, 20);
  const StripedLightField light_field(mesh.positions.size(), GetParam());
  const auto camera = testing::plain_camera(320, 240);
  const auto context = make_osmesa_context();
  const auto gpu = make_gl_surface_renderer(*context, mesh, light_field);
  const auto cpu = make_reference_surface_renderer(mesh, light_field, 1);
  for (const Eigen::Vector3d& from :
       {Eigen::Vector3d(1, 0.4, 0.5), Eigen::Vector3d(-1, 0.2, -0.6)}) {
    const auto pose = testing::looking_at_origin(from, 0.36);
    const RenderedView a = gpu->render(camera, pose);
    const RenderedView b = cpu->render(camera, pose);
    const cv::Mat interior = testing::common_interior(a.mask, b.mask, 1);
    const testing::Difference found = testing::difference(a.image, b.image, interior);
    std::cout << "mean " << found.mean << " q99.9 " << found.quantile_999 << " max "
              << found.largest << " over " << found.pixels << " pixels\n";
    EXPECT_GT(found.pixels, 5000u);
    EXPECT_LE(found.mean, 0.1);
    EXPECT_LE(found.quantile_999, 1.0);
    if (GetParam() == 0) {
      EXPECT_LE(found.largest, 1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Unseen, EvaluatedAgreement, ::testing::Values(0, 5));

// A change shows after its upload, not before, also when the eye stays where it is.
TEST(EvaluatedRenderer, ShowsChangesAfterUpload) {
  const core::Mesh mesh = testing::sphere(0.1f, 12);
  StripedLightField light_field(mesh.positions.size(), 5);
  const auto camera = testing::plain_camera(160, 120);
  const auto pose = testing::looking_at_origin({1, 0.4, 0.5}, 0.36);
  const auto context = make_osmesa_context();
  const auto renderer = make_gl_surface_renderer(*context, mesh, light_field);
  const cv::Mat before = renderer->render(camera, pose).image;
  light_field.phase = 0.6f;
  EXPECT_EQ(cv::norm(renderer->render(camera, pose).image, before, cv::NORM_INF), 0);
  renderer->upload(std::array<std::uint32_t, 1>{0});
  const cv::Mat after = renderer->render(camera, pose).image;
  // Red rises by 0.4 of 255 everywhere.
  EXPECT_GT(cv::norm(after, before, cv::NORM_INF), 100);
  const cv::Mat fresh =
      make_gl_surface_renderer(*context, mesh, light_field)->render(camera, pose).image;
  EXPECT_EQ(cv::norm(after, fresh, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace sheen::render
