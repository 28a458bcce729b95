// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "core/geometry/disc_map.h"
#include "fitting/nearest_views/light_field_model.h"
#include "fitting/nearest_views/model_codec.h"
#include "fitting/nearest_views/nearest_fitter.h"
#include "tests/fitting/models_for_tests.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace sheen::fitting::nearest_views {
namespace {

using fitting::testing::colour_of;
using fitting::testing::disc_grid;
using fitting::testing::isolated;
using fitting::testing::one_sample;
using fitting::testing::scattered;
using fitting::testing::teach;

constexpr unsigned kSeed = 1618;

std::unique_ptr<PatchFitter> make(std::size_t patches = 1) {
  return make_nearest_fitter(isolated(patches), 1);
}

Eigen::Vector3d wavy(double u, double v) {
  return {0.5 + 0.4 * std::sin(5 * u), 0.5 + 0.4 * std::cos(4 * v), 0.3 + 0.2 * u * v};
}

// Towards a sample its own weight is 1 / 1e-4 times nearly 1, the two others' together less than
// 2 / (angle between samples): with angles above 0.05 they have less than 2 * 20 / 1e4 = 0.4 %.
TEST(NearestViews, InterpolatesTheSamples) {
  std::vector<Eigen::Vector2d> directions;
  for (int x = -6; x <= 6; ++x) {
    for (int y = -6; y <= 6; ++y) {
      if (x * x + y * y < 40) directions.emplace_back(x / 8.0, y / 8.0);  // exact in a half
    }
  }
  const auto fitted = make();
  teach(*fitted, directions, wavy);
  for (const Eigen::Vector2d& x : directions) {
    EXPECT_LT(
        (colour_of(fitted->light_field(), 0, x.cast<float>()).cast<double>() - wavy(x.x(), x.y()))
            .cwiseAbs()
            .maxCoeff(),
        0.004 * 0.8 + 1.0 / 2048);
  }
}

// The same in double, by sorting all angles.
TEST(NearestViews, EqualsTheFormula) {
  const auto fitted = make();
  teach(*fitted, scattered(60, kSeed), wavy);
  const auto& model = dynamic_cast<const LightFieldModel&>(fitted->light_field());
  for (const Eigen::Vector2f& uv : disc_grid(9, 17)) {
    const Eigen::Vector3d d = core::hemisphere_from_disc(uv).cast<double>();
    std::vector<std::pair<double, Eigen::Vector3d>> by_angle;
    for (const StoredSample& s : model.samples(0)) {
      const Eigen::Vector2f at(static_cast<float>(s[0]), static_cast<float>(s[1]));
      const Eigen::Vector3d other = core::hemisphere_from_disc(at).cast<double>();
      const Eigen::Vector3f colour(static_cast<float>(s[2]), static_cast<float>(s[3]),
                                   static_cast<float>(s[4]));
      by_angle.emplace_back(std::atan2(d.cross(other).norm(), d.dot(other)), colour.cast<double>());
    }
    std::ranges::sort(by_angle, {}, [](const auto& entry) { return entry.first; });
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0;
    for (int i = 0; i < 3; ++i) {
      const double w = (1 - by_angle[i].first / by_angle[3].first) / by_angle[i].first;
      sum += w * by_angle[i].second;
      weights += w;
    }
    // Floats, and the floor of a weight, 1e-4 of 1 / angle.
    EXPECT_LT((colour_of(model, 0, uv).cast<double>() - sum / weights).cwiseAbs().maxCoeff(), 1e-3)
        << uv.transpose() << " seed " << kSeed;
  }
}

// A blend of samples stays among them, however they lie.
TEST(NearestViews, StaysInTheRangeOfTheSamples) {
  for (const std::size_t count : {1u, 2u, 3u, 4u, 5u, 40u}) {
    const auto fitted = make();
    teach(*fitted, scattered(count, kSeed), wavy);
    const auto& model = dynamic_cast<const LightFieldModel&>(fitted->light_field());
    Eigen::Array3f low = Eigen::Array3f::Constant(2.0f);
    Eigen::Array3f high = Eigen::Array3f::Constant(-1.0f);
    for (const StoredSample& s : model.samples(0)) {
      const Eigen::Array3f colour(static_cast<float>(s[2]), static_cast<float>(s[3]),
                                  static_cast<float>(s[4]));
      low = low.min(colour);
      high = high.max(colour);
    }
    for (const Eigen::Vector2f& uv : disc_grid(8, 16)) {
      const Eigen::Array3f value = colour_of(model, 0, uv).array();
      EXPECT_TRUE((value >= low - 1e-6f).all() && (value <= high + 1e-6f).all()) << count;
    }
  }
}

// Repeated directions are averaged; samples that are no numbers are not kept.
TEST(NearestViews, DegenerateSamplesAreFinite) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const auto fitted = make();
  for (const double level : {0.25, 0.75, 0.25, 0.75, 0.5}) {
    fitted->integrate(one_sample(0, {0.5, 0.5}, Eigen::Vector3d::Constant(level)));
    fitted->integrate(one_sample(0, {nan, 0}, {0, 0, 0}));
    fitted->integrate(one_sample(0, {0, 0}, {0, nan, 0}));
  }
  EXPECT_EQ(fitted->statistics().samples, 5u);
  for (const Eigen::Vector2f& uv : disc_grid(4, 8)) {
    const Eigen::Vector3f value = colour_of(fitted->light_field(), 0, uv);
    EXPECT_TRUE((value.array() >= 0.25f).all() && (value.array() <= 0.75f).all());
  }
}

// No sample: mid grey with hardly any weight. After `finish` the neighbours' mean, and the first
// sample replaces that.
TEST(NearestViews, UnseenPatches) {
  const auto fitted = make_nearest_fitter({{0, 1, 2}, {1, 0}}, 1);
  EXPECT_EQ(fitted->light_field().evaluate(1, {0, 0}).weight_sum, kUnseenWeight);
  EXPECT_EQ(colour_of(fitted->light_field(), 1, {0, 0}), Eigen::Vector3f::Constant(0.5f));
  fitted->integrate(one_sample(0, {0.1, 0.2}, {0.25, 0.5, 0.75}));
  EXPECT_EQ(fitted->finish().elements, std::vector<std::uint32_t>{1});
  EXPECT_EQ(colour_of(fitted->light_field(), 1, {0.7f, 0}), Eigen::Vector3f(0.25f, 0.5f, 0.75f));
  fitted->integrate(one_sample(1, {-0.5, 0}, {1, 1, 1}));
  EXPECT_EQ(colour_of(fitted->light_field(), 1, {0.7f, 0}), Eigen::Vector3f(1, 1, 1));
  // Two samples of five numbers.
  EXPECT_EQ(fitted->light_field().coefficient_count(), 10u);
}

TEST(NearestViewsFile, ReadsBackBitByBit) {
  const tests::TemporaryFolder folder;
  const core::Mesh mesh = fitting::testing::octahedron();
  const auto fitted = fitting::testing::fitted("nearest-views", mesh);
  write_model(folder / "a.glb", mesh, fitted->light_field());
  const Model read = read_model(folder / "a.glb");
  EXPECT_EQ(dynamic_cast<const LightFieldModel&>(*read.light_field).observed(),
            fitted->light_field().observed());
  EXPECT_EQ(read.light_field->coefficient_count(), fitted->light_field().coefficient_count());
  write_model(folder / "b.glb", read.mesh, *read.light_field);
  EXPECT_TRUE(tests::read_file(folder / "a.glb") == tests::read_file(folder / "b.glb"));
}

TEST(NearestViewsFile, BrokenPartsAreRefused) {
  LightFieldModel model(3);
  model.add(0, {0.1f, 0.2f}, {0.3f, 0.4f, 0.5f});
  model.add(0, {0.2f, 0.2f}, {0.3f, 0.4f, 0.5f});
  model.add(1, {0.3f, 0.2f}, {0.3f, 0.4f, 0.5f});
  const ModelPart good = encode_model(model);
  const core::Mesh mesh = fitting::testing::points(3);
  EXPECT_NO_THROW(decode_model(good, mesh));
  // Wrong lengths.
  for (const char* name : {"counts", "samples"}) {
    for (std::size_t length = 0; length < good.arrays.at(name).size(); ++length) {
      ModelPart bad = good;
      bad.arrays[name] = good.arrays.at(name).first(length);
      EXPECT_THROW(decode_model(bad, mesh), ModelFault) << name << length;
    }
    ModelPart absent = good;
    absent.arrays.erase(name);
    EXPECT_THROW(decode_model(absent, mesh), ModelFault);
  }
  // Counts 2, 1, 0: every other count asks for another length or another flag.
  std::array<std::uint32_t, 3> counts{2, 1, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    for (int bit = 0; bit < 32; ++bit) {
      counts[i] ^= 1u << bit;
      ModelPart bad = good;
      bad.arrays["counts"] = std::as_bytes(std::span(counts));
      EXPECT_THROW(decode_model(bad, mesh), ModelFault) << i << " " << bit;
      counts[i] ^= 1u << bit;
    }
  }
  counts = {1, 1, 1};
  ModelPart bad = good;
  bad.arrays["counts"] = std::as_bytes(std::span(counts));
  EXPECT_NO_THROW(decode_model(bad, mesh));
  EXPECT_THROW(decode_model(bad, fitting::testing::points(4)), ModelFault);
  counts = {3, 0, 0};
  EXPECT_THROW(decode_model(bad, mesh), ModelFault);
  // A direction off the disc, a number that is none.
  for (const std::uint16_t bits : std::array<std::uint16_t, 3>{0x4000, 0x7e00, 0xfc00}) {
    std::vector<std::uint16_t> numbers(15);
    std::memcpy(numbers.data(), good.arrays.at("samples").data(), 30);
    numbers[5] = bits;
    ModelPart changed = good;
    changed.arrays["samples"] = std::as_bytes(std::span(numbers));
    EXPECT_THROW(decode_model(changed, mesh), ModelFault) << bits;
  }
}

}  // namespace
}  // namespace sheen::fitting::nearest_views
