// SPDX-License-Identifier: MIT
#include "fitting/model_file/model_file.h"

#include "core/diagnostics/error.h"
#include "fitting/mean/mean_light_field.h"
#include "fitting/model_file/glb.h"
#include "tests/fitting/models_for_tests.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

namespace sheen::fitting {
namespace {

using testing::fitted;
using testing::octahedron;
using tests::read_file;

template <typename T>
bool same_bits(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

void expect_same_model(const Model& model, const core::Mesh& mesh,
                       const PatchLightField& light_field) {
  EXPECT_TRUE(same_bits<Eigen::Vector3f>(model.mesh.positions, mesh.positions));
  EXPECT_TRUE(same_bits<Eigen::Vector3f>(model.mesh.normals, mesh.normals));
  EXPECT_EQ(model.mesh.triangles, mesh.triangles);
  EXPECT_EQ(model.light_field->representation(), light_field.representation());
  EXPECT_EQ(as_patches(*model.light_field)->observed(), light_field.observed());
  if (const auto* expected = dynamic_cast<const iwls::LightFieldModel*>(&light_field)) {
    const auto& read = dynamic_cast<const iwls::LightFieldModel&>(*model.light_field);
    EXPECT_TRUE(same_bits(read.coefficients(), expected->coefficients()));
    EXPECT_EQ(read.shape().centers, expected->shape().centers);
    EXPECT_EQ(read.shape().layout, expected->shape().layout);
    EXPECT_EQ(read.shape().terms, expected->shape().terms);
    EXPECT_EQ(read.shape().support_radius, expected->shape().support_radius);
  } else {
    EXPECT_TRUE(
        same_bits(dynamic_cast<const mean::MeanLightField&>(*model.light_field).coefficients(),
                  dynamic_cast<const mean::MeanLightField&>(light_field).coefficients()));
  }
}

void expect_round_trip(const std::string& name, const OptionValues& options) {
  const tests::TemporaryFolder folder;
  const core::Mesh mesh = octahedron();
  const auto fitter = fitted(name, mesh, options);
  write_model(folder / "a.glb", mesh, fitter->light_field());
  const Model model = read_model(folder / "a.glb");
  expect_same_model(model, mesh, fitter->light_field());
  write_model(folder / "b.glb", model.mesh, *model.light_field);
  EXPECT_TRUE(read_file(folder / "a.glb") == read_file(folder / "b.glb"));
}

TEST(ModelFile, KeepsFromWhereItWasLookedAt) {
  const tests::TemporaryFolder folder;
  const core::Mesh mesh = octahedron();
  const auto fitter = fitted("mean", mesh, {});
  SeenDirections seen(mesh.positions.size());
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = 0x8000000000000001U * (i + 1);
  write_model(folder / "a.glb", mesh, fitter->light_field(), seen);
  EXPECT_EQ(read_model(folder / "a.glb").seen, seen);
  // A file that does not say is one of before, and stays readable.
  write_model(folder / "b.glb", mesh, fitter->light_field());
  EXPECT_TRUE(read_model(folder / "b.glb").seen.empty());
}

TEST(ModelFile, ReadsBackBitByBit) {
  expect_round_trip("mean", {});
  for (const int terms : {0, 1, 3, 6}) {
    testing::for_all_options(terms, false, [](const iwls::Options& options) {
      if (options.construction != iwls::Construction::quadtree) return;
      expect_round_trip("iwls", testing::values_of(options));
    });
  }
}

// Half floats: 2 bytes per coefficient, and little more than that per patch.
TEST(ModelFile, StoresSixteenBitsPerCoefficient) {
  const tests::TemporaryFolder folder;
  core::Mesh mesh = octahedron();
  const auto size_with = [&](int terms) {
    const auto fitter = fitted("iwls", mesh, {{"centers", "64"}, {"terms", std::to_string(terms)}});
    write_model(folder / "m.glb", mesh, fitter->light_field());
    return std::filesystem::file_size(folder / "m.glb");
  };
  // 6 patches x 64 centres x 3 more terms x 3 channels x 2 bytes; the text differs by a few digits.
  EXPECT_NEAR(static_cast<double>(size_with(6)) - static_cast<double>(size_with(3)),
              6 * 64 * 3 * 3 * 2, 16);
}

// Mid grey .5 in sRGB is ((.5 + .055) / 1.055)^2.4 = .21404 of 65535 = 14027 in linear vertex
// colours.
TEST(ModelFile, VertexColoursAreLinear) {
  const tests::TemporaryFolder folder;
  const core::Mesh mesh = octahedron();
  const auto untouched = make_fitter("mean", mesh);
  write_model(folder / "grey.glb", mesh, untouched->light_field());
  const std::string file = read_file(folder / "grey.glb");
  const Glb glb = parse_glb(file);
  const auto& accessor =
      glb.document["accessors"][glb.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]
                                    .get<std::size_t>()];
  const auto& view = glb.document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  std::array<std::uint16_t, 4> colour;
  std::memcpy(colour.data(), glb.binary.data() + view["byteOffset"].get<std::size_t>(), 8);
  EXPECT_EQ(colour, (std::array<std::uint16_t, 4>{14027, 14027, 14027, 65535}));
}

TEST(ModelFile, AFailingWriteLeavesTheOldFile) {
  const tests::TemporaryFolder folder;
  tests::write_file(folder / "plain", "not a folder");
  const core::Mesh mesh = octahedron();
  const auto fitter = fitted("mean", mesh);
  EXPECT_THROW(write_model((folder / "plain") / "m.glb", mesh, fitter->light_field()), core::Error);
  EXPECT_EQ(read_file(folder / "plain"), "not a folder");
}

}  // namespace
}  // namespace sheen::fitting
