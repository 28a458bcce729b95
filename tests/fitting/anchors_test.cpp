// SPDX-License-Identifier: MIT
// Directions at anchors instead of vertices.
#include "core/atlas/atlas.h"
#include "core/geometry/disc_map.h"
#include "core/geometry/tangent_frame.h"
#include "core/mesh/interpolation.h"
#include "core/samples/vertex_view.h"
#include "fitting/detail/detail_light_field.h"
#include "fitting/model_file/model_file.h"
#include "fitting/model_file/model_part.h"
#include "tests/fitting/photographs_for_tests.h"
#include "tests/fitting/samples_for_tests.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>

namespace sheen::fitting {
namespace {

using detail::AnchorBlend;
using detail::AnchoredOffsets;
using detail::AnchorLevel;
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

Eigen::Vector3f mirror(const Eigen::Vector3f& n, const Eigen::Vector3f& w) {
  return 2.0f * n.dot(w) * n - w;
}

Eigen::Vector3f in_object(const core::TangentFrame& frame, const Eigen::Vector2f& uv) {
  return frame.in_object(core::hemisphere_from_disc(uv));
}

// An anchor is asked in the direction of the place's own ray, or in the one whose mirror image at
// the anchor's normal is that of the ray at the place's normal.
TEST(Anchors, AreAskedInTheSameOrTheMirroredDirection) {
  const core::Mesh mesh = render::testing::sphere(0.1f, 16);
  const std::vector<AnchorLevel> levels{{detail::scatter_anchors(mesh, 0.02f), 0.02f}};
  const Eigen::Vector3f middle = Eigen::Vector3f::Constant(1.0f / 3.0f);
  for (const AskedDirection asked : {AskedDirection::same, AskedDirection::mirrored}) {
    const AnchoredOffsets anchors(mesh, levels, asked,
                                  sparse::LightFieldModel(levels[0].vertices.size()));
    for (std::size_t triangle = 0; triangle < mesh.triangles.size(); triangle += 7) {
      const Eigen::Vector3f n = core::normal_on(mesh, triangle, middle);
      const Eigen::Vector3f w = in_object(core::tangent_frame(n), {0.3f, -0.4f});
      for (const detail::CornerWeights& blend : anchors.blends(triangle)) {
        const core::TangentFrame& frame = anchors.frame(blend.anchor);
        const Eigen::Vector3f w_a = in_object(frame, anchors.uv_at(blend.anchor, n, w));
        if (asked == AskedDirection::same) {
          EXPECT_LT((w_a - w).norm(), 1e-5f) << triangle;
        } else {
          EXPECT_LT((mirror(frame.normal, w_a) - mirror(n, w)).norm(), 1e-5f) << triangle;
        }
      }
    }
  }
}

/// Patches of a linear base that differ from anchor to anchor.
sparse::LightFieldModel slopes(std::size_t count) {
  sparse::LightFieldModel models(count);
  for (std::size_t i = 0; i < count; ++i) {
    sparse::PatchModel patch;
    patch.base_terms = sparse::kLinearBase;
    for (std::size_t term = 0; term < sparse::kLinearBase; ++term) {
      const auto phase = static_cast<float>(i + 3 * term);
      patch.coefficient[term] = {std::sin(phase), std::sin(2 * phase), std::sin(3 * phase)};
    }
    models.store(i, patch);
  }
  return models;
}

// Levels are added up: what two say together is what each says alone. Within a triangle the weights
// of its corners change linearly, and add up to 1 on every level.
TEST(Anchors, LevelsAddUp) {
  const core::Mesh mesh = render::testing::torus_knot(0.2f, 96, 12);
  const AnchorLevel coarse{detail::scatter_anchors(mesh, 0.05f), 0.05f};
  const AnchorLevel fine{detail::scatter_anchors(mesh, 0.02f), 0.02f};
  const std::size_t first = coarse.vertices.size();
  const std::size_t all = first + fine.vertices.size();
  sparse::LightFieldModel models = slopes(all);
  sparse::LightFieldModel of_coarse(first), of_fine(all - first);
  for (std::size_t i = 0; i < first; ++i) of_coarse.store(i, models.patch(i));
  for (std::size_t i = first; i < all; ++i) of_fine.store(i - first, models.patch(i));
  const auto asked = AskedDirection::mirrored;
  const AnchoredOffsets both(mesh, {coarse, fine}, asked, std::move(models));
  const AnchoredOffsets alone(mesh, {coarse}, asked, std::move(of_coarse));
  const AnchoredOffsets other(mesh, {fine}, asked, std::move(of_fine));
  const Eigen::Vector3f place(0.2f, 0.3f, 0.5f);
  for (std::size_t triangle = 0; triangle < mesh.triangles.size(); triangle += 5) {
    const Eigen::Vector3f w =
        in_object(core::tangent_frame(core::normal_on(mesh, triangle, place)), {0.3f, 0.2f});
    const Eigen::Vector3f sum = alone.colour(triangle, place, w) + other.colour(triangle, place, w);
    EXPECT_LT((both.colour(triangle, place, w) - sum).norm(), 1e-5f) << triangle;
    Eigen::Vector3f weights = Eigen::Vector3f::Zero();
    for (const detail::CornerWeights& blend : both.blends(triangle)) {
      weights += Eigen::Vector3f::Map(blend.weight.data());
    }
    EXPECT_LT((weights - Eigen::Vector3f::Constant(2.0f)).norm(), 1e-5f) << triangle;
  }
}

/// Patches with RBFs besides that base.
sparse::LightFieldModel bumps(std::size_t count) {
  sparse::LightFieldModel models = slopes(count);
  for (std::size_t i = 0; i < count; ++i) {
    sparse::PatchModel patch = models.patch(i);
    patch.rbf_count = i % 7;
    for (std::size_t rbf = 0; rbf < patch.rbf_count; ++rbf) {
      patch.atom[rbf] = static_cast<std::uint16_t>((11 * i + 43 * rbf) % sparse::atoms().size());
      patch.coefficient[patch.base_terms + rbf] = patch.coefficient[rbf % sparse::kLinearBase];
    }
    models.store(i, patch);
  }
  return models;
}

// Eight directions and more at once, from all sides: what is asked for one after another, but for
// rounding: of coefficients below 1 a few 1e-6; on the rim one by one leaves a height of up to
// sqrt(1e-7) = 3e-4 where there is none, times sqrt(3) on two levels.
TEST(Anchors, AreAskedForManyDirectionsAtOnce) {
  const core::Mesh mesh = render::testing::torus_knot(0.2f, 96, 12);
  const AnchorLevel coarse{detail::scatter_anchors(mesh, 0.05f), 0.05f};
  const AnchorLevel fine{detail::scatter_anchors(mesh, 0.02f), 0.02f};
  constexpr std::size_t count = 24;
  std::array<std::array<float, count>, 3> w{}, said{};
  const Eigen::Vector3f place(0.2f, 0.3f, 0.5f);
  for (const AskedDirection asked : {AskedDirection::same, AskedDirection::mirrored}) {
    const AnchoredOffsets anchors(mesh, {coarse, fine}, asked,
                                  bumps(coarse.vertices.size() + fine.vertices.size()));
    for (std::size_t triangle = 0; triangle < mesh.triangles.size(); triangle += 5) {
      std::array<Eigen::Vector3f, count> directions;
      for (std::size_t i = 0; i < count; ++i) {
        const auto turn = static_cast<float>(triangle + 7 * i);
        directions[i] =
            Eigen::Vector3f(std::sin(turn), std::cos(2.0f * turn), std::sin(3.0f * turn))
                .normalized();
        for (std::size_t axis = 0; axis < 3; ++axis) {
          w[axis][i] = directions[i][static_cast<Eigen::Index>(axis)];
          said[axis][i] = 1.0f;
        }
      }
      anchors.add(triangle, place, {w[0].data(), w[1].data(), w[2].data(), count},
                  {said[0].data(), said[1].data(), said[2].data()});
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3f n = core::normal_on(mesh, triangle, place);
        const bool on_rim = std::ranges::any_of(anchors.blends(triangle), [&](const auto& blend) {
          return anchors.uv_at(blend.anchor, n, directions[i]).norm() > 0.9999f;
        });
        const Eigen::Vector3f one = anchors.colour(triangle, place, directions[i]);
        const Eigen::Vector3f of_many(said[0][i] - 1.0f, said[1][i] - 1.0f, said[2][i] - 1.0f);
        EXPECT_LT((of_many - one).norm(), on_rim ? 1.2e-3f : 1e-5f) << triangle << " " << i;
      }
    }
  }
}

// How colours change with the direction is what the surface does, known in closed form, at the
// middles of triangles and in the directions of the views: .005 of its squares are missed.
TEST(Anchors, SayHowTheSurfaceChanges) {
  const Photographs& views = glossy_sphere();
  const core::Mesh& mesh = views.mesh();
  const auto fitter = finished(views, "10");
  const DetailLightField& model = model_of(*fitter);
  std::vector<Eigen::Vector3f> eyes;
  views.observe(first(16), [&](const core::Observation& observation) {
    eyes.push_back(core::eye_in_object(observation.camera_from_object));
  });
  const Eigen::Vector3f middle = Eigen::Vector3f::Constant(1.0f / 3.0f);
  double change = 0, missed = 0;
  for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    const Eigen::Vector3f place = core::place_on(mesh, triangle, middle);
    std::vector<Eigen::Vector3f> truth, said;
    for (const Eigen::Vector3f& eye : eyes) {
      const Eigen::Vector3f w = (eye - place).normalized();
      if (w.dot(core::normal_on(mesh, triangle, middle)) < 0.3f) continue;
      truth.push_back(glossy(place, w));
      said.push_back(model.between_patches(triangle, middle, w));
    }
    const auto mean = [](const std::vector<Eigen::Vector3f>& of) -> Eigen::Vector3f {
      return std::accumulate(of.begin(), of.end(), Eigen::Vector3f(Eigen::Vector3f::Zero())) /
             static_cast<float>(of.size());
    };
    if (truth.empty()) continue;
    const Eigen::Vector3f of_truth = mean(truth), of_said = mean(said);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const Eigen::Vector3f wanted = truth[i] - of_truth;
      change += static_cast<double>(wanted.squaredNorm());
      missed += static_cast<double>((said[i] - of_said - wanted).squaredNorm());
    }
  }
  EXPECT_LT(missed, 0.016 * change);
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

// 40 texels of 1.3 mm are wider than the 20 mm between vertices: fewer models.
TEST(Anchors, TakeFewerBytesThanVertices) {
  const Photographs& views = glossy_sphere();
  auto plain = make_fitter("detail", views.mesh(), {{"texel-mm", "1.3"}, {"offsets", "vertex"}});
  views.show(first(16), *plain);
  plain->finish();
  const auto anchored = finished(views, "40");
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

// Files of versions that knew one level say how far apart its anchors are, and no counts.
TEST_F(AnchorsInAFile, OfOneLevelMaySayItsSpacingAlone) {
  const core::Mesh& mesh = glossy_sphere().mesh();
  const AnchorLevel level{detail::scatter_anchors(mesh, 0.03f), 0.03f};
  DetailLightField model(mesh, core::make_atlas(mesh, 0.01f, std::size_t{1} << 20));
  model.set_anchors(std::make_shared<const AnchoredOffsets>(
      mesh, std::vector{level}, AskedDirection::mirrored, slopes(level.vertices.size())));
  const Descriptor& descriptor = representation_named("detail");
  ModelPart part = descriptor.encode(model);
  part.parameters.erase("anchorLevels");
  part.parameters["anchorSpacing"] = static_cast<double>(level.spacing_m);
  const auto read = descriptor.decode(part, mesh);
  for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    EXPECT_EQ(dynamic_cast<const DetailLightField&>(*read).evaluate(vertex, {0.2f, 0.1f}).colour(),
              model.evaluate(vertex, {0.2f, 0.1f}).colour());
  }
  for (const nlohmann::json& spacing : nlohmann::json({0, -1, 1e300, "wide", 1e3})) {
    part.parameters["anchorSpacing"] = spacing;
    EXPECT_THROW(static_cast<void>(descriptor.decode(part, mesh)), ModelFault) << spacing;
  }
}

TEST_F(AnchorsInAFile, WithBrokenContentAreRefused) {
  EXPECT_NO_THROW(static_cast<void>(read([](ModelPart&) {})));
  std::vector<std::uint32_t> vertices;
  for (const AnchorLevel& level : model_of(*fitter_).anchors()->levels()) {
    vertices.insert(vertices.end(), level.vertices.begin(), level.vertices.end());
  }
  const auto with_vertices = [&](const std::vector<std::uint32_t>& changed) {
    return
        [changed](ModelPart& part) { part.arrays["anchors"] = std::as_bytes(std::span(changed)); };
  };
  const auto with_spacing = [](const nlohmann::json& spacing) {
    return [spacing](ModelPart& part) { part.parameters["anchorLevels"][0]["spacing"] = spacing; };
  };
  const auto with_count = [](const nlohmann::json& count) {
    return [count](ModelPart& part) { part.parameters["anchorLevels"][1]["count"] = count; };
  };
  const auto with_levels = [](const nlohmann::json& levels) {
    return [levels](ModelPart& part) { part.parameters["anchorLevels"] = levels; };
  };
  auto beyond = vertices, twice = vertices, dense = vertices, fewer = vertices;
  beyond.back() = static_cast<std::uint32_t>(glossy_sphere().mesh().positions.size());
  twice[1] = twice[0];
  std::iota(dense.begin(), dense.end(), 0u);
  fewer.pop_back();
  std::vector<std::uint32_t> backwards(vertices.rbegin(), vertices.rend());
  const nlohmann::json empty_level = {{"count", 0}, {"spacing", 1.0}};
  const std::vector<Change> changes{
      with_vertices(beyond),
      with_vertices(twice),
      with_vertices(dense),
      with_vertices(fewer),
      with_vertices(backwards),
      with_vertices({}),
      with_spacing(0),
      with_spacing(-1),
      with_spacing(1e300),
      with_spacing(1e-300),
      with_spacing("wide"),
      with_spacing(1e3),
      with_count(0),
      with_count(-1),
      with_count(vertices.size()),
      with_count(std::uint64_t{1} << 40),
      with_count("many"),
      with_levels(1),
      with_levels(nlohmann::json::array()),
      with_levels({1, 2}),
      with_levels({empty_level, empty_level, empty_level, empty_level, empty_level}),
      [](ModelPart& part) { part.arrays["anchors"] = part.arrays["anchors"].first(5); },
      [](ModelPart& part) { part.parameters["anchorLevels"][0].erase("spacing"); },
      [](ModelPart& part) { part.parameters["anchorLevels"][0].erase("count"); },
      [](ModelPart& part) { part.parameters.erase("anchorLevels"); },
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
