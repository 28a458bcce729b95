// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "render/surface/patch_buffer.h"
#include "render/surface/patch_shader.h"
#include "render/surface/surface_renderer.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace sheen::render {
namespace {

using fitting::iwls::Layout;

/// A representation nobody draws.
class UnknownLightField final : public fitting::PatchLightField {
 public:
  [[nodiscard]] std::string_view representation() const override { return "unknown"; }
  [[nodiscard]] std::size_t patch_count() const override { return 1; }
  [[nodiscard]] fitting::WeightedColour evaluate(std::size_t /*patch_idx*/,
                                                 const Eigen::Vector2f& /*uv*/) const override {
    return {Eigen::Vector3f::Zero(), 1.0f};
  }
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t /*patch_idx*/) const override {
    return Eigen::Vector3f::Zero();
  }
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override { return observed_; }
  [[nodiscard]] std::size_t coefficient_count() const override { return 0; }

 private:
  std::vector<std::uint8_t> observed_{1};
};

/// Ranges handed to NamedBufferSubData, as (offset, bytes).
std::vector<std::array<std::size_t, 2>> sent;
PFNGLNAMEDBUFFERSUBDATAPROC real_sub_data = nullptr;
void APIENTRY recording_sub_data(GLuint buffer, GLintptr offset, GLsizeiptr size,
                                 const void* data) {
  sent.push_back({static_cast<std::size_t>(offset), static_cast<std::size_t>(size)});
  real_sub_data(buffer, offset, size, data);
}

TEST(PatchShader, SendsNeighbouringPatchesTogetherAndNothingElse) {
  const auto context = make_osmesa_context();
  gl::Functions gl = gl::load_functions(*context);
  real_sub_data = gl.NamedBufferSubData;
  gl.NamedBufferSubData = recording_sub_data;
  const auto model = testing::random_iwls(Layout::grid, 16, 3, 100, 0);
  const auto shader = make_patch_shader(gl, model);

  // 16 centres x 3 terms x 3 channels x 2 bytes behind a texel of 8: 296 bytes per patch.
  sent.clear();
  EXPECT_EQ(shader->upload(std::array<std::uint32_t, 6>{0, 1, 7, 8, 9, 99}), 6u * 296u);
  const std::vector<std::array<std::size_t, 2>> expected{
      {0, 2 * 296}, {7 * 296, 3 * 296}, {99 * 296, 296}};
  EXPECT_EQ(sent, expected);

  sent.clear();
  EXPECT_EQ(shader->upload({}), 0u);
  EXPECT_TRUE(sent.empty());
}

TEST(PatchShader, MeanSendsEightBytesPerPatch) {
  const auto context = make_osmesa_context();
  const gl::Functions gl = gl::load_functions(*context);
  const auto model = testing::random_mean(10, 0);
  EXPECT_EQ(make_patch_shader(gl, model)->upload(std::array<std::uint32_t, 2>{3, 9}), 16u);
}

TEST(PatchShader, UnknownRepresentationIsNamed) {
  const auto context = make_osmesa_context();
  const gl::Functions gl = gl::load_functions(*context);
  try {
    make_patch_shader(gl, UnknownLightField());
    FAIL() << "an unknown representation was accepted";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("unknown"), std::string::npos) << error.what();
  }
}

TEST(PatchBuffer, RefusesMoreTexelsThanTheDriverHolds) {
  const auto context = make_osmesa_context();
  const gl::Functions gl = gl::load_functions(*context);
  const auto limit = static_cast<std::size_t>(gl::integer_limit(gl, GL_MAX_TEXTURE_BUFFER_SIZE));
  try {
    const PatchBuffer buffer(gl, limit / 384 + 1, 384);
    FAIL() << "more than " << limit << " texels were accepted";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(limit)), std::string::npos)
        << error.what();
  }
}

// Uploading what changed equals uploading everything, pixel for pixel; before the upload the
// image is the old one.
TEST(PatchShader, PartialUploadEqualsFullUpload) {
  const core::Mesh mesh = testing::sphere(0.1f, 16);
  auto model = testing::random_iwls(Layout::grid, 16, 3, mesh.positions.size(), 4);
  const auto camera = testing::plain_camera(160, 120);
  const auto pose = testing::looking_at_origin({1, 0.4, 0.5}, 0.36);
  const auto context = make_osmesa_context();
  const auto renderer = make_gl_surface_renderer(*context, mesh, model);
  const cv::Mat before = renderer->render(camera, pose).image;

  // Change every seventh patch and its successor, colour and flag.
  std::vector<std::uint32_t> written;
  for (std::uint32_t patch = 0; patch + 1 < mesh.positions.size(); patch += 7) {
    for (const std::uint32_t changed : {patch, patch + 1}) {
      model.store_constant(changed, {0.9f, 0.1f, 0.5f});
      model.store_observed(changed, changed % 2 == 0);
      written.push_back(changed);
    }
  }
  EXPECT_EQ(cv::norm(renderer->render(camera, pose).image, before, cv::NORM_INF), 0);
  renderer->upload(written);
  const cv::Mat partial = renderer->render(camera, pose).image;
  const cv::Mat full = make_gl_surface_renderer(*context, mesh, model)->render(camera, pose).image;
  EXPECT_EQ(cv::norm(partial, full, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(partial, before, cv::NORM_INF), 50);
}

}  // namespace
}  // namespace sheen::render
