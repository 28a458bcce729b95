// SPDX-License-Identifier: MIT
// Directions at anchors instead of vertices.
#include "core/geometry/disc_map.h"
#include "core/geometry/tangent_frame.h"
#include "fitting/detail/detail_light_field.h"
#include "fitting/model_file/model_file.h"
#include "fitting/model_file/model_part.h"
#include "tests/fitting/photographs_for_tests.h"
#include "tests/fitting/samples_for_tests.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>

namespace sheen::fitting {
namespace {

using detail::AnchorBlend;
using detail::AnchoredOffsets;
using detail::AskedDirection;
using detail::DetailLightField;
using testing::Photographs;

/// A tint along z under a broad highlight of a light that stands above.
Eigen::Vector3f glossy(const Eigen::Vector3f& p, const Eigen::Vector3f& towards_viewer) {
  const Eigen::Vector3f half = (towards_viewer + Eigen::Vector3f(0.3f, 0.2f, 0.93f)).normalized();
  const float highlight = std::pow(std::max(0.0f, p.normalized().dot(half)), 8.0f);
  return Eigen::Vector3f(0.3f, 0.3f + 2.0f * p.z(), 0.2f) +
         Eigen::Vector3f::Constant(0.4f * highlight);
}

const Photographs& glossy_sphere() {
  static const Photographs photographs(render::testing::sphere(0.1f, 16), 16, glossy);
  return photographs;
}

std::vector<int> first(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

std::unique_ptr<Fitter> make(const core::Mesh& mesh, const std::string& anchor_px,
                             int threads = 1) {
  return make_fitter("detail", mesh,
                     {{"texel-mm", "1.3"}, {"offsets", "anchors"}, {"anchor-px", anchor_px}},
                     threads);
}

const DetailLightField& model_of(const Fitter& fitter) {
  return dynamic_cast<const DetailLightField&>(fitter.light_field());
}

std::unique_ptr<Fitter> finished(const Photographs& views, const std::string& anchor_px,
                                 int threads = 1) {
  auto fitter = make(views.mesh(), anchor_px, threads);
  views.show(first(16), *fitter);
  fitter->finish();
  return fitter;
}

float distance(const core::Mesh& mesh, std::uint32_t a, std::uint32_t b, float spacing_m) {
  return std::hypot((mesh.positions[a] - mesh.positions[b]).norm(),
                    spacing_m * (mesh.normals[a] - mesh.normals[b]).norm());
}

// Poisson disc: no two nearer than the spacing, no vertex as far as that from all.
TEST(Anchors, LieApartAndEverywhere) {
  const core::Mesh mesh = render::testing::torus_knot(0.2f, 96, 12);
  for (const float spacing_m : {0.004f, 0.02f, 0.5f}) {
    const std::vector<std::uint32_t> anchors = detail::scatter_anchors(mesh, spacing_m);
    EXPECT_TRUE(detail::are_scattered(mesh, anchors, spacing_m));
    for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
      float nearest = 1e9f;
      for (const std::uint32_t anchor : anchors) {
        if (anchor == vertex) continue;
        nearest = std::min(nearest, distance(mesh, vertex, anchor, spacing_m));
      }
      const bool is_anchor = std::ranges::binary_search(anchors, vertex);
      EXPECT_EQ(is_anchor, nearest >= spacing_m) << vertex;
    }
  }
}

// Weights are positive, add up to 1 and are largest for the nearest; at an anchor with no other in
// reach it is all.
TEST(Anchors, BlendsAreAPartitionOfUnity) {
  const core::Mesh mesh = render::testing::torus_knot(0.2f, 96, 12);
  constexpr float spacing_m = 0.02f;
  const auto anchors = detail::scatter_anchors(mesh, spacing_m);
  const auto blends = detail::blend_anchors(mesh, anchors, spacing_m);
  ASSERT_EQ(blends.size(), mesh.positions.size());
  std::size_t several = 0;
  for (std::uint32_t vertex = 0; vertex < blends.size(); ++vertex) {
    const AnchorBlend& blend = blends[vertex];
    EXPECT_NEAR(std::accumulate(blend.weight.begin(), blend.weight.end(), 0.0f), 1.0f, 1e-6f);
    EXPECT_TRUE(std::ranges::is_sorted(blend.weight, std::greater{}));
    EXPECT_GE(blend.weight.back(), 0.0f);
    EXPECT_LT(distance(mesh, vertex, anchors[blend.anchor[0]], spacing_m), spacing_m);
    several += blend.weight[1] > 0.0f ? 1 : 0;
  }
  EXPECT_GT(several, blends.size() / 2);
  const std::vector<std::uint32_t> alone{0};
  EXPECT_EQ(detail::blend_anchors(mesh, alone, spacing_m)[0].weight[0], 1.0f);
}

// An anchor is asked in the direction of the vertex's own ray, or in the one whose mirror image at
// the anchor's normal is that of the ray at the vertex's normal.
TEST(Anchors, AreAskedInTheSameOrTheMirroredDirection) {
  const core::Mesh mesh = render::testing::sphere(0.1f, 16);
  const detail::AnchorLayout layout{detail::scatter_anchors(mesh, 0.02f), 0.02f};
  const auto mirror = [](const Eigen::Vector3f& n, const Eigen::Vector3f& w) -> Eigen::Vector3f {
    return 2.0f * n.dot(w) * n - w;
  };
  for (const AskedDirection asked : {AskedDirection::same, AskedDirection::mirrored}) {
    const AnchoredOffsets anchors(mesh, layout, asked,
                                  sparse::LightFieldModel(layout.vertices.size()));
    for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); vertex += 7) {
      const std::uint32_t anchor = anchors.blends()[vertex].anchor[0];
      const Eigen::Vector2f uv(0.3f, -0.4f);
      const auto world = [](const Eigen::Vector3f& normal, const Eigen::Vector2f& at) {
        const core::TangentFrame frame = core::tangent_frame(normal);
        const Eigen::Vector3f local = core::hemisphere_from_disc(at);
        return Eigen::Vector3f(local.x() * frame.tangent + local.y() * frame.bitangent +
                               local.z() * frame.normal);
      };
      const Eigen::Vector3f& n = mesh.normals[vertex];
      const Eigen::Vector3f& n_a = mesh.normals[layout.vertices[anchor]];
      const Eigen::Vector3f w = world(n, uv);
      const Eigen::Vector3f w_a = world(n_a, anchors.uv_at(anchor, vertex, uv));
      if (asked == AskedDirection::same) {
        EXPECT_LT((w_a - w).norm(), 1e-5f) << vertex;
      } else {
        EXPECT_LT((mirror(n_a, w_a) - mirror(n, w)).norm(), 1e-5f) << vertex;
      }
    }
  }
}

// With every vertex an anchor of its own, offsets are those at vertices but for their means, which
// the texture takes: the same samples go through the same choice of terms. Samples are kept in
// steps of 1/32767 and coefficients as halves, so a step of 1/255 is far above what differs.
TEST(Anchors, AsDenseAsVerticesAreTheVertices) {
  const Photographs& views = glossy_sphere();
  const auto anchored = finished(views, "0.01");
  auto plain = make_fitter("detail", views.mesh(), {{"texel-mm", "1.3"}});
  views.show(first(16), *plain);
  plain->finish();
  ASSERT_NE(model_of(*anchored).anchors(), nullptr);
  std::size_t differs = 0;
  for (std::size_t vertex = 0; vertex < views.mesh().positions.size(); ++vertex) {
    const auto change = [&](const Fitter& fitter) -> Eigen::Vector3f {
      const DetailLightField& model = model_of(fitter);
      return model.interpolated_part(vertex, {0.3f, 0.2f}).colour() -
             model.interpolated_part(vertex, {-0.1f, 0.1f}).colour();
    };
    EXPECT_LT((change(*anchored) - change(*plain)).cwiseAbs().maxCoeff(), 1.0f / 255) << vertex;
    differs += change(*plain).norm() > 0.02f ? 1 : 0;
  }
  EXPECT_GT(differs, views.mesh().positions.size() / 4);
}

// A surface of one colour has nothing to say about directions: no anchor is left.
TEST(Anchors, AConstantObjectHasNone) {
  const Photographs views(render::testing::sphere(0.1f, 12), 16, [](const auto&, const auto&) {
    return Eigen::Vector3f(0.2f, 0.4f, 0.6f);
  });
  EXPECT_EQ(model_of(*finished(views, "4")).anchors(), nullptr);
}

TEST(Anchors, ThreadsDoNotChangeABit) {
  const Photographs& views = glossy_sphere();
  const std::string one = testing::bytes_of(finished(views, "10", 1)->light_field());
  EXPECT_EQ(one, testing::bytes_of(finished(views, "10", 2)->light_field()));
  EXPECT_EQ(one, testing::bytes_of(finished(views, "10", 8)->light_field()));
}

// 20 texels of 1.3 mm are wider than the 20 mm between vertices: fewer models.
TEST(Anchors, TakeFewerBytesThanVertices) {
  const Photographs& views = glossy_sphere();
  auto plain = make_fitter("detail", views.mesh(), {{"texel-mm", "1.3"}});
  views.show(first(16), *plain);
  plain->finish();
  const auto anchored = finished(views, "20");
  EXPECT_LT(byte_size(anchored->light_field()), byte_size(plain->light_field()));
}

// While views arrive offsets are at the vertices; more may come after `finish`.
TEST(Anchors, AreLeftWhenMoreViewsArrive) {
  const Photographs& views = glossy_sphere();
  const auto twice = make(views.mesh(), "10");
  const auto once = make_fitter("detail", views.mesh(), {{"texel-mm", "1.3"}});
  views.show(first(15), *twice);
  views.show(first(15), *once);
  EXPECT_EQ(testing::bytes_of(twice->light_field()), testing::bytes_of(once->light_field()));
  twice->finish();
  EXPECT_NE(model_of(*twice).anchors(), nullptr);
  views.observe({15}, [&](const core::Observation& observation) {
    const ModelUpdate& update = twice->integrate(observation);
    EXPECT_GE(update.elements.size(), views.mesh().positions.size());
    EXPECT_TRUE(std::ranges::is_sorted(update.elements));
  });
  EXPECT_EQ(model_of(*twice).anchors(), nullptr);
  twice->finish();
  EXPECT_EQ(testing::bytes_of(twice->light_field()),
            testing::bytes_of(finished(views, "10")->light_field()));
}

class AnchorsInAFile : public ::testing::Test {
 protected:
  /// A change of the part that a file holds.
  using Change = std::function<void(ModelPart& part)>;

  /// The part read back, changed.
  [[nodiscard]] std::unique_ptr<const LightField> read(const Change& change) const {
    const Descriptor& descriptor = representation_named("detail");
    ModelPart part = descriptor.encode(fitter_->light_field());
    change(part);
    return descriptor.decode(part, glossy_sphere().mesh());
  }

  std::unique_ptr<Fitter> fitter_ = finished(glossy_sphere(), "10");
};

TEST_F(AnchorsInAFile, GiveBackEveryBit) {
  const tests::TemporaryFolder folder;
  const core::Mesh& mesh = glossy_sphere().mesh();
  write_model(folder / "a.glb", mesh, fitter_->light_field());
  const Model model = read_model(folder / "a.glb");
  write_model(folder / "b.glb", model.mesh, *model.light_field);
  EXPECT_TRUE(tests::read_file(folder / "a.glb") == tests::read_file(folder / "b.glb"));
  const auto& written = model_of(*fitter_);
  const auto& read = dynamic_cast<const DetailLightField&>(*model.light_field);
  for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    EXPECT_EQ(read.evaluate(vertex, {0.2f, -0.5f}).colour(),
              written.evaluate(vertex, {0.2f, -0.5f}).colour());
  }
  EXPECT_EQ(read.coefficient_count(), written.coefficient_count());
}

TEST_F(AnchorsInAFile, WithBrokenContentAreRefused) {
  EXPECT_NO_THROW(static_cast<void>(read([](ModelPart&) {})));
  const auto vertices = model_of(*fitter_).anchors()->layout().vertices;
  const auto with_vertices = [&](const std::vector<std::uint32_t>& changed) {
    return
        [changed](ModelPart& part) { part.arrays["anchors"] = std::as_bytes(std::span(changed)); };
  };
  auto beyond = vertices, twice = vertices, dense = vertices, fewer = vertices;
  beyond.back() = static_cast<std::uint32_t>(glossy_sphere().mesh().positions.size());
  twice[1] = twice[0];
  std::iota(dense.begin(), dense.end(), 0u);
  fewer.pop_back();
  std::vector<std::uint32_t> backwards(vertices.rbegin(), vertices.rend());
  const std::vector<Change> changes{
      with_vertices(beyond),
      with_vertices(twice),
      with_vertices(dense),
      with_vertices(fewer),
      with_vertices(backwards),
      with_vertices({}),
      [](ModelPart& part) { part.arrays["anchors"] = part.arrays["anchors"].first(5); },
      [](ModelPart& part) { part.parameters["anchorSpacing"] = 0; },
      [](ModelPart& part) { part.parameters["anchorSpacing"] = -1; },
      [](ModelPart& part) { part.parameters["anchorSpacing"] = 1e300; },
      [](ModelPart& part) { part.parameters["anchorSpacing"] = 1e-300; },
      [](ModelPart& part) { part.parameters["anchorSpacing"] = "wide"; },
      [](ModelPart& part) { part.parameters["anchorSpacing"] = 1e3; },
      [](ModelPart& part) { part.parameters.erase("anchorSpacing"); },
      [](ModelPart& part) { part.parameters["mirrored"] = 1; },
      [](ModelPart& part) { part.parameters.erase("mirrored"); },
      [](ModelPart& part) { part.arrays.erase("anchors"); },
      [](ModelPart& part) { part.arrays.erase("coefficients"); },
      [](ModelPart& part) { part.observed = part.observed.first(3); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_THROW(static_cast<void>(read(changes[i])), ModelFault) << i;
  }
}

}  // namespace
}  // namespace sheen::fitting
