// SPDX-License-Identifier: MIT
// A texture and patches, fitted to photographs of known surfaces.
#include "fitting/detail/detail_light_field.h"
#include "fitting/model_file/model_file.h"
#include "fitting/undo/undoable_fitter.h"
#include "tests/fitting/photographs_for_tests.h"
#include "tests/fitting/samples_for_tests.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>

namespace sheen::fitting {
namespace {

using detail::DetailLightField;
using testing::Photographs;

/// Stripes 8 mm wide and a tint along z.
Eigen::Vector3f print(const Eigen::Vector3f& p, const Eigen::Vector3f& /*towards_viewer*/) {
  const float stripe = 0.5f + 0.4f * std::sin(800.0f * (p.x() + 0.5f * p.y()));
  return {stripe, 0.3f + 2.0f * p.z(), 0.6f - 0.4f * stripe};
}

/// The print under a broad highlight.
Eigen::Vector3f glossy(const Eigen::Vector3f& p, const Eigen::Vector3f& towards_viewer) {
  const float highlight = std::max(0.0f, p.normalized().dot(towards_viewer));
  return 0.7f * print(p, towards_viewer) +
         Eigen::Vector3f::Constant(0.25f * highlight * highlight * highlight);
}

std::unique_ptr<Fitter> make(const core::Mesh& mesh, int threads = 1,
                             const std::string& texel_mm = "1.3") {
  return make_fitter("detail", mesh, {{"texel-mm", texel_mm}}, threads);
}

const DetailLightField& model_of(const Fitter& fitter) {
  return dynamic_cast<const DetailLightField&>(fitter.light_field());
}

/// All there is of a model.
std::string bytes_of(const Fitter& fitter) {
  const auto texels = std::as_bytes(std::span(model_of(fitter).texture().texels()));
  return testing::bytes_of(fitter.light_field()) + testing::text_of(texels);
}

std::vector<int> first(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

const Photographs& glossy_sphere() {
  static const Photographs photographs(render::testing::sphere(0.1f, 16), 12, glossy);
  return photographs;
}

TEST(Detail, ThreadsDoNotChangeABit) {
  const Photographs& views = glossy_sphere();
  std::vector<std::string> live, finished;
  for (const int threads : {1, 2, 8}) {
    const auto fitter = make(views.mesh(), threads);
    views.show(first(12), *fitter);
    live.push_back(bytes_of(*fitter));
    fitter->finish();
    finished.push_back(bytes_of(*fitter));
  }
  EXPECT_EQ(live[0], live[1]);
  EXPECT_EQ(live[0], live[2]);
  EXPECT_EQ(finished[0], finished[1]);
  EXPECT_EQ(finished[0], finished[2]);
  EXPECT_NE(live[0], finished[0]);
}

// Integer sums: the texture is the same in any order, before `finish` and after it. (Texels that no
// view showed take their colour from the patches, whose sums are not exact; all of these are seen.
// Nor are what anchors say on average, which is taken off.)
TEST(Detail, TheTextureDoesNotDependOnTheOrderOfViews) {
  const Photographs& views = glossy_sphere();
  const auto at_vertices = [&] {
    return make_fitter("detail", views.mesh(), {{"texel-mm", "1.3"}, {"offsets", "vertex"}});
  };
  const auto forwards = at_vertices();
  const auto shuffled = at_vertices();
  views.show(first(12), *forwards);
  views.show({7, 2, 11, 0, 5, 9, 1, 10, 4, 8, 3, 6}, *shuffled);
  EXPECT_EQ(model_of(*forwards).texture().texels(), model_of(*shuffled).texture().texels());
  forwards->finish();
  shuffled->finish();
  EXPECT_EQ(model_of(*forwards).texture().texels(), model_of(*shuffled).texture().texels());
}

TEST(Detail, UndoneViewsLeaveNoBit) {
  const Photographs& views = glossy_sphere();
  UndoableFitter undone([&] { return make(views.mesh()); },
                        [&](std::span<const int> frames, const auto& observe) {
                          views.observe({frames.begin(), frames.end()}, observe);
                        });
  const auto never_saw = make(views.mesh());
  views.show(first(9), undone);
  undone.undo(4, [](const core::SampleBatch&, const LightField&) {});
  views.show(first(5), *never_saw);
  views.show({9, 10, 11}, undone);
  views.show({9, 10, 11}, *never_saw);
  undone.finish();
  never_saw->finish();
  EXPECT_EQ(bytes_of(undone), bytes_of(*never_saw));
}

// More views after `finish`, and `finish` again: as if it had been called once.
TEST(Detail, FinishMayBeCalledInBetween) {
  const Photographs& views = glossy_sphere();
  const auto twice = make(views.mesh());
  const auto once = make(views.mesh());
  views.show(first(6), *twice);
  twice->finish();
  views.show({6, 7, 8, 9, 10, 11}, *twice);
  twice->finish();
  views.show(first(12), *once);
  once->finish();
  EXPECT_EQ(model_of(*twice).texture().texels(), model_of(*once).texture().texels());
}

// A surface of one colour, without noise: one texel per chart, of that colour, and no patch has
// anything to say about directions.
TEST(Detail, AConstantObjectIsOneColour) {
  const Photographs views(render::testing::sphere(0.1f, 12), 12, [](const auto&, const auto&) {
    return Eigen::Vector3f(0.2f, 0.4f, 0.6f);
  });
  const auto fitter = make(views.mesh());
  views.show(first(12), *fitter);
  fitter->finish();
  const DetailLightField& model = model_of(*fitter);
  for (std::size_t patch = 0; patch < model.patch_count(); ++patch) {
    EXPECT_EQ(model.offsets().patch(patch).term_count(), 1u);
    EXPECT_EQ(model.offsets().colour(patch, {0.3f, 0.1f}), Eigen::Vector3f::Zero());
  }
  EXPECT_LE(model.texture().texel_count().stored, model.texture().atlas().charts.size());
  EXPECT_GT(model.texture().texel_count().offered, 1000u);
  for (const Texel& texel : model.texture().texels()) {
    const bool is_colour = texel == Texel{51, 102, 153};
    const bool is_unused = texel == Texel{128, 128, 128};
    EXPECT_TRUE(is_colour || is_unused);
  }
}

// What was seen is a mean: a matte print without noise is found again, and far better than vertices
// 10 mm apart could show stripes of 8 mm. Between two centres of texels 1.3 mm apart the stripes
// bend by at most (1.3 / 2)^2 / 2 * .4 * (.8 / mm)^2 = .05, and pixels are as wide.
TEST(Detail, FindsPrintBetweenTheVertices) {
  const Photographs views(render::testing::sphere(0.1f, 32), 24, print);
  const auto fitter = make(views.mesh());
  views.show(first(24), *fitter);
  fitter->finish();
  const DetailLightField& model = model_of(*fitter);
  double squared = 0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < views.mesh().triangles.size(); ++t) {
    Eigen::Vector3f centre = Eigen::Vector3f::Zero();
    for (const std::uint32_t vertex : views.mesh().triangles[t]) {
      centre += views.mesh().positions[vertex] / 3.0f;
    }
    if (std::abs(centre.z()) > 0.07f) continue;  // seen obliquely
    const Eigen::Vector3f found = model.texture().at(t, Eigen::Vector3f::Constant(1.0f / 3.0f));
    squared += static_cast<double>((found - print(centre, {})).squaredNorm()) / 3;
    ++count;
  }
  EXPECT_GT(count, 1000u);
  EXPECT_LT(std::sqrt(squared / static_cast<double>(count)), 0.05);
}

TEST(Detail, ChangesAreNamedOnceAndInOrder) {
  const Photographs& views = glossy_sphere();
  const auto fitter = make(views.mesh());
  std::vector<Texel> before = model_of(*fitter).texture().texels();
  views.observe(first(4), [&](const core::Observation& observation) {
    const std::vector<std::uint32_t> changed = fitter->integrate(observation).elements;
    EXPECT_TRUE(std::ranges::is_sorted(changed));
    EXPECT_EQ(std::ranges::adjacent_find(changed), changed.end());
    const SurfaceTexture& texture = model_of(*fitter).texture();
    const std::size_t patches = model_of(*fitter).patch_count();
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (texture.texels()[i] == before[i]) continue;
      EXPECT_TRUE(std::ranges::binary_search(changed, patches + texture.page_of(i)));
    }
    before = texture.texels();
  });
}

// Four large triangles; a triangle alone; texels larger than the object; points without triangles.
TEST(Detail, SmallMeshesAndLargeTexels) {
  core::Mesh one;
  one.positions = {{0, -0.05f, 0}, {0, 0.05f, 0}, {0, 0, 0.08f}};
  one.normals.assign(3, Eigen::Vector3f::UnitX());
  one.triangles = {{0, 1, 2}};
  for (const core::Mesh& mesh : {render::testing::tetrahedron(0.1f), one}) {
    const Photographs views(mesh, 6, print);
    for (const char* const texel_mm : {"0.7", "5000"}) {
      const auto fitter = make(mesh, 2, texel_mm);
      views.show(first(6), *fitter);
      fitter->finish();
      for (std::size_t patch = 0; patch < model_of(*fitter).patch_count(); ++patch) {
        EXPECT_TRUE(model_of(*fitter).evaluate(patch, {0.1f, 0.2f}).colour().allFinite());
      }
    }
  }
  core::Mesh points;
  points.positions.assign(3, Eigen::Vector3f::Zero());
  points.normals.assign(3, Eigen::Vector3f::UnitZ());
  const auto fitter = make(points);
  fitter->finish();
  EXPECT_EQ(model_of(*fitter).mean_colour(0), model_of(*fitter).mean_colour(2));
}

// Half a million triangles, most of them without a texel or a pixel of their own: the texture grows
// with the surface and not with the mesh (4 pi (100 mm)^2 / (1.3 mm)^2 = 74,000 texels, and as many
// again for the rims of charts and the vertices' share), and reads everywhere as the one colour.
TEST(Detail, AMeshFarFinerThanItsTexels) {
  const Eigen::Vector3f colour(0.2f, 0.4f, 0.6f);
  const Photographs views(render::testing::sphere(0.1f, 355), 2,
                          [&](const auto&, const auto&) { return colour; });
  const auto& triangles = views.mesh().triangles;
  ASSERT_GT(triangles.size(), 500'000u);
  const auto fitter = make(views.mesh(), 2);
  views.show(first(2), *fitter);
  fitter->finish();
  const SurfaceTexture& texture = model_of(*fitter).texture();
  EXPECT_LT(texture.texel_count().offered, 150'000u);
  for (std::size_t t = 0; t < triangles.size(); t += 997) {
    const Eigen::Vector3f found = texture.at(t, Eigen::Vector3f::Constant(1.0f / 3.0f));
    EXPECT_LT((found - colour).cwiseAbs().maxCoeff(), 2.0f / 255) << t;
  }
}

// Half of a sphere is never seen: its texels take what the patches around them have.
TEST(Detail, UnseenFacesTakeTheirNeighboursColour) {
  const Eigen::Vector3f colour(0.8f, 0.4f, 0.2f);
  const Photographs views(render::testing::sphere(0.1f, 12), 1,
                          [&](const auto&, const auto&) { return colour; });
  const auto fitter = make(views.mesh());
  views.show({0}, *fitter);
  fitter->finish();
  for (std::size_t t = 0; t < views.mesh().triangles.size(); ++t) {
    const Eigen::Vector3f found =
        model_of(*fitter).texture().at(t, Eigen::Vector3f::Constant(1.0f / 3.0f));
    EXPECT_LT((found - colour).cwiseAbs().maxCoeff(), 2.0f / 255) << t;
  }
}

TEST(Detail, TheModelFileGivesBackEveryBit) {
  const tests::TemporaryFolder folder;
  const Photographs& views = glossy_sphere();
  const auto fitter = make(views.mesh());
  views.show(first(12), *fitter);
  for (const bool finished : {false, true}) {
    if (finished) fitter->finish();
    write_model(folder / "a.glb", views.mesh(), fitter->light_field());
    const Model model = read_model(folder / "a.glb");
    const auto& written = model_of(*fitter);
    const auto& read = dynamic_cast<const DetailLightField&>(*model.light_field);
    EXPECT_EQ(model.mesh.positions, views.mesh().positions);
    EXPECT_EQ(model.mesh.normals, views.mesh().normals);
    EXPECT_EQ(model.mesh.triangles, views.mesh().triangles);
    EXPECT_EQ(read.texture().texels(), written.texture().texels());
    EXPECT_EQ(read.texture().texel_count().stored, written.texture().texel_count().stored);
    EXPECT_EQ(read.texture().atlas().width, written.texture().atlas().width);
    EXPECT_EQ(read.texture().atlas().corners, written.texture().atlas().corners);
    EXPECT_EQ(testing::bytes_of(read), testing::bytes_of(written));
    write_model(folder / "b.glb", model.mesh, *model.light_field);
    EXPECT_TRUE(tests::read_file(folder / "a.glb") == tests::read_file(folder / "b.glb"));
  }
}

TEST(Detail, RefusesTexelsWithoutSize) {
  EXPECT_THROW(make(render::testing::tetrahedron(1), 1, "0"), std::invalid_argument);
  EXPECT_THROW(make(render::testing::tetrahedron(1), 1, "nan"), std::invalid_argument);
}

}  // namespace
}  // namespace sheen::fitting
