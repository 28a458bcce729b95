// SPDX-License-Identifier: MIT
// A texture added to sparse patches: OpenGL against the reference renderer, which reads the texture
// on the CPU.
#include "fitting/detail/detail_light_field.h"
#include "render/surface/patch_shader.h"
#include "render/surface/surface_renderer.h"
#include "tests/fitting/sparse_models_for_tests.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <algorithm>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace sheen::render {
namespace {

using fitting::detail::DetailLightField;

constexpr unsigned kSeed = 31;

/// Texels and patches at random, texels about as large as the pixels of these tests.
DetailLightField random_detail(const core::Mesh& mesh) {
  std::mt19937 random(kSeed);
  DetailLightField model(mesh, core::make_atlas(mesh, 0.0011f, std::size_t{1} << 22));
  for (fitting::Texel& texel : model.texture().texels()) {
    for (std::uint8_t& channel : texel) channel = static_cast<std::uint8_t>(random() % 256);
  }
  for (std::size_t patch = 0; patch < model.patch_count(); ++patch) {
    fitting::sparse::PatchModel offset = fitting::testing::random_patch(random, 3);
    offset.coefficient[0].array() -= 0.5f;
    model.offsets().store(patch, offset);
    model.offsets().store_observed(patch, patch % 5 != 0);
  }
  return model;
}

/// The same with offsets at anchors, at random, too, on two levels.
DetailLightField random_anchored(const core::Mesh& mesh, fitting::detail::AskedDirection asked) {
  using fitting::detail::AnchoredOffsets;
  std::mt19937 random(kSeed + 1);
  DetailLightField model = random_detail(mesh);
  model.offsets() = fitting::detail::no_offsets(model.observed());
  std::vector<fitting::detail::AnchorLevel> levels;
  std::size_t count = 0;
  for (const float spacing_m : {0.05f, 0.02f}) {
    levels.push_back({fitting::detail::scatter_anchors(mesh, spacing_m), spacing_m});
    count += levels.back().vertices.size();
  }
  fitting::sparse::LightFieldModel models =
      fitting::detail::no_offsets(std::vector<std::uint8_t>(count, 1));
  for (std::size_t anchor = 0; anchor < models.patch_count(); ++anchor) {
    fitting::sparse::PatchModel offset = fitting::testing::random_patch(random, 6);
    offset.coefficient[0].array() -= 0.5f;
    if (offset.term_count() > 1) models.store(anchor, offset);
  }
  model.set_anchors(
      std::make_shared<const AnchoredOffsets>(mesh, levels, asked, std::move(models)));
  return model;
}

struct View {
  const char* name;
  core::Mesh mesh;
  core::CameraModel camera;
  int most;  ///< difference, steps of 1/255
};

std::vector<View> views() {
  return {{"a sphere", testing::sphere(0.1f, 20), testing::plain_camera(320, 240), 1},
          {"a knot", testing::torus_knot(0.2f, 96, 12), testing::plain_camera(320, 240), 1},
          {"large triangles through a lens", testing::tetrahedron(0.12f),
           testing::distorted_camera(320, 240), 13},
          {"hundreds of triangles through a lens", testing::sphere(0.1f, 12),
           testing::distorted_camera(320, 240), 13}};
}

void expect_gpu_equals_reference(Context& context, const View& view,
                                 const DetailLightField& model) {
  const auto pose = testing::looking_at_origin({1, 0.4, 0.5}, 0.4);
  const RenderedView gpu =
      make_gl_surface_renderer(context, view.mesh, model)->render(view.camera, pose);
  const RenderedView cpu =
      make_reference_surface_renderer(view.mesh, model, 1)->render(view.camera, pose);
  const cv::Mat interior = testing::common_interior(gpu.mask, cpu.mask, 2);
  const testing::Difference found = testing::difference(gpu.image, cpu.image, interior);
  std::cout << view.name << ": mean " << found.mean << " 99.9 % " << found.quantile_999 << " max "
            << found.largest << " over " << found.pixels << " pixels\n";
  EXPECT_GT(found.pixels, 3000u) << view.name;
  EXPECT_LE(found.quantile_999, view.most) << view.name;
}

// Hardware reads textures with 8 bits between two texels, 1/2 of a step of 1/255 at most; places
// are interpolated in single precision on both sides.
TEST(DetailRenderer, GpuEqualsReference) {
  const auto context = make_osmesa_context();
  for (const View& view : views()) {
    expect_gpu_equals_reference(*context, view, random_detail(view.mesh));
  }
}

// Anchors blend on both sides alike, asked in either direction, where triangles are cut for a lens,
// too.
TEST(DetailRenderer, AnchorsOnTheGpuEqualTheReference) {
  const auto context = make_osmesa_context();
  for (const View& view : views()) {
    for (const auto asked :
         {fitting::detail::AskedDirection::same, fitting::detail::AskedDirection::mirrored}) {
      expect_gpu_equals_reference(*context, view, random_anchored(view.mesh, asked));
    }
  }
}

// A renderer that was made before a model had anchors shows them after the next upload, and no
// longer once they are gone.
TEST(DetailRenderer, AnchorsComeAndGo) {
  const core::Mesh mesh = testing::sphere(0.1f, 20);
  const auto camera = testing::plain_camera(320, 240);
  const auto pose = testing::looking_at_origin({1, 0.4, 0.5}, 0.4);
  const auto context = make_osmesa_context();
  DetailLightField model = random_anchored(mesh, fitting::detail::AskedDirection::mirrored);
  const cv::Mat with = make_gl_surface_renderer(*context, mesh, model)->render(camera, pose).image;
  const auto anchors = model.anchors();
  model.set_anchors(nullptr);
  const auto renderer = make_gl_surface_renderer(*context, mesh, model);
  const cv::Mat without = renderer->render(camera, pose).image;
  model.set_anchors(anchors);
  EXPECT_GT(renderer->upload({}), 0u);
  EXPECT_EQ(cv::norm(renderer->render(camera, pose).image, with, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(without, with, cv::NORM_INF), 20);
  model.set_anchors(nullptr);
  renderer->upload({});
  EXPECT_EQ(cv::norm(renderer->render(camera, pose).image, without, cv::NORM_INF), 0);
}

// Sending what changed shows the same image as a renderer made for the changed model.
TEST(DetailRenderer, ChangedPagesAndPatchesEqualAFreshStart) {
  const core::Mesh mesh = testing::sphere(0.1f, 16);
  DetailLightField model = random_detail(mesh);
  const auto camera = testing::plain_camera(160, 120);
  const auto pose = testing::looking_at_origin({1, 0.4, 0.5}, 0.36);
  const auto context = make_osmesa_context();
  const auto renderer = make_gl_surface_renderer(*context, mesh, model);
  const cv::Mat before = renderer->render(camera, pose).image;

  // Every third page turns white, every second patch is left alone.
  std::vector<std::uint32_t> changed;
  for (std::uint32_t patch = 0; patch < model.patch_count(); patch += 2) {
    fitting::sparse::PatchModel none;
    none.coefficient[0].setZero();
    model.offsets().store(patch, none);
    changed.push_back(patch);
  }
  const auto width = static_cast<std::size_t>(model.texture().atlas().width);
  std::size_t bytes = 0;
  for (std::size_t page = 0; page < model.texture().page_count(); page += 3) {
    const cv::Rect part = model.texture().page(page);
    for (int y = part.y; y < part.y + part.height; ++y) {
      const auto row = model.texture().texels().begin() +
                       static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * width);
      std::fill_n(row + part.x, part.width, fitting::Texel{255, 255, 255});
    }
    bytes += static_cast<std::size_t>(part.area()) * sizeof(fitting::Texel);
    changed.push_back(static_cast<std::uint32_t>(model.patch_count() + page));
  }
  EXPECT_GE(renderer->upload(changed), bytes);
  const cv::Mat after = renderer->render(camera, pose).image;
  const cv::Mat fresh = make_gl_surface_renderer(*context, mesh, model)->render(camera, pose).image;
  EXPECT_EQ(cv::norm(after, fresh, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(after, before, cv::NORM_INF), 20);
  EXPECT_EQ(renderer->upload({}), 0u);
}

}  // namespace
}  // namespace sheen::render
