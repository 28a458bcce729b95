// SPDX-License-Identifier: MIT
#include "fitting/spherical_harmonics/basis.h"
#include "fitting/spherical_harmonics/harmonics_fitter.h"
#include "fitting/spherical_harmonics/light_field_model.h"
#include "fitting/spherical_harmonics/model_codec.h"
#include "tests/fitting/models_for_tests.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace sheen::fitting::spherical_harmonics {
namespace {

using fitting::testing::isolated;
using fitting::testing::one_sample;
using fitting::testing::scattered;
using fitting::testing::teach;
using fitting::testing::worst_error;

constexpr unsigned kSeed = 2718;
constexpr double kPi = 3.14159265358979323846;

std::unique_ptr<PatchFitter> make(const Options& options) {
  return make_harmonics_fitter(isolated(1), options, 1);
}

double z_of(double u, double v) {
  return std::sqrt(std::max(0.0, 1 - u * u - v * v));
}

// Gauss-like sum over the sphere: equal steps in z and azimuth. Orthonormal means unit diagonal.
TEST(SphericalHarmonics, BasisIsOrthonormal) {
  constexpr int steps = 400;
  constexpr int azimuths = 16;  // exact for orders up to 2 * 3 < 16
  Eigen::Matrix<double, 16, 16> gram = Eigen::Matrix<double, 16, 16>::Zero();
  for (int i = 0; i < steps; ++i) {
    const double z = -1 + (2.0 * i + 1) / steps;
    const double r = std::sqrt(1 - z * z);
    for (int j = 0; j < azimuths; ++j) {
      const double angle = 2 * kPi * j / azimuths;
      const auto Y = basis<16>(r * std::cos(angle), r * std::sin(angle), z);
      const Eigen::Map<const Eigen::Matrix<double, 16, 1>> y(Y.data());
      gram += y * y.transpose() * (4 * kPi / (steps * azimuths));
    }
  }
  // The midpoint rule in z is off by (2 / 400)^2 / 24 times a second derivative below 400.
  EXPECT_LT((gram - Eigen::Matrix<double, 16, 16>::Identity()).cwiseAbs().maxCoeff(), 1e-3);
}

// The smaller bases are the beginning of the larger ones.
TEST(SphericalHarmonics, BasesAreNested) {
  const auto Y = basis<16>(0.36, 0.48, 0.8);
  const auto Y2 = basis<9>(0.36, 0.48, 0.8);
  const auto Y1 = basis<4>(0.36, 0.48, 0.8);
  EXPECT_TRUE(std::equal(Y2.begin(), Y2.end(), Y.begin()));
  EXPECT_TRUE(std::equal(Y1.begin(), Y1.end(), Y.begin()));
}

// Every function of the degree is reproduced everywhere, up to what 16-bit coefficients hold: 16
// terms of size below 1, |Y| <= 1, each off by 2^-12. Functions of a higher degree are not.
TEST(SphericalHarmonics, ReproducesItsOwnFunctions) {
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    for (std::size_t term = 0; term < term_count(degree); ++term) {
      const auto truth = [&](double u, double v) {
        const double y = basis<16>(u, v, z_of(u, v))[term];
        return Eigen::Vector3d(0.4 + 0.3 * y, 0.5 - 0.2 * y, y);
      };
      const auto fitted = make({degree, 1e-6});
      teach(*fitted, scattered(300, kSeed), truth);
      EXPECT_LT(worst_error(fitted->light_field(), truth), 16.0 / 4096)
          << "degree " << degree << " term " << term << " seed " << kSeed;
      if (degree == kMaxDegree || term < term_count(degree - 1) || degree == 1) continue;
      const auto lower = make({degree - 1, 1e-6});
      teach(*lower, scattered(300, kSeed), truth);
      EXPECT_GT(worst_error(lower->light_field(), truth), 0.02) << degree << " " << term;
    }
  }
}

// The constant is not penalised: whatever the ridge and however few the samples, a constant stays
// one. 1/2^12 relative rounding of c / Y_00, times .9.
TEST(SphericalHarmonics, ConstantIsExact) {
  const auto truth = [](double, double) { return Eigen::Vector3d(0.9, 0.5, 0.1); };
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    for (const std::size_t count : {1u, 2u, 5u, 100u}) {
      const auto fitted = make({degree, 5.0});
      teach(*fitted, scattered(count, kSeed), truth);
      EXPECT_LT(worst_error(fitted->light_field(), truth), 0.9 / 2048) << degree << " " << count;
    }
  }
}

// A strong ridge leaves only the constant: the mean of the samples, here (0 + 1) / 2.
TEST(SphericalHarmonics, RidgePullsToTheMean) {
  const auto fitted = make({1, 1000.0});
  fitted->integrate(one_sample(0, {0.5, 0}, {1, 1, 1}));
  fitted->integrate(one_sample(0, {-0.5, 0}, {0, 0, 0}));
  fitted->finish();
  // The slope that remains: x^T y / (x^T x + ridge) of the column k1 x = +-.244, so below .3 /
  // 1000.
  EXPECT_LT(worst_error(fitted->light_field(),
                        [](double, double) { return Eigen::Vector3d::Constant(0.5).eval(); }),
            1e-3);
}

Eigen::Vector3f coloured(double x) {
  return {static_cast<float>(x), static_cast<float>(0.5 * x), static_cast<float>(1 - x)};
}

// Turning all directions about the normal turns the result: the ridge treats all m of an l alike.
TEST(SphericalHarmonics, TurnsWithTheSamples) {
  const Eigen::Rotation2Dd turn(0.7);
  const auto truth = [](double u, double v) {
    return Eigen::Vector3d(0.5 + 0.3 * u * v, 0.4 + 0.2 * std::sin(3 * u), 0.3 + 0.2 * v);
  };
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    const auto straight = make({degree, 0.01});
    const auto turned = make({degree, 0.01});
    for (const Eigen::Vector2d& x : scattered(60, kSeed)) {
      straight->integrate(one_sample(0, x, truth(x.x(), x.y())));
      turned->integrate(one_sample(0, turn * x, truth(x.x(), x.y())));
    }
    for (const Eigen::Vector2f& x : fitting::testing::disc_grid(6, 12)) {
      const Eigen::Vector2f y = (turn * x.cast<double>()).cast<float>();
      // Up to 16 coefficients below 4 are rounded by 2^-11 of a unit each, on both sides.
      EXPECT_LT((fitting::testing::colour_of(straight->light_field(), 0, x) -
                 fitting::testing::colour_of(turned->light_field(), 0, y))
                    .cwiseAbs()
                    .maxCoeff(),
                2 * 16.0f / 2048)
          << degree;
    }
  }
}

// Half the light gives half the coefficients: a power of two, so bit by bit.
TEST(SphericalHarmonics, GainIsLinear) {
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    const auto bright = make({degree, 0.01});
    const auto dark = make({degree, 0.01});
    for (const Eigen::Vector2d& x : scattered(40, kSeed)) {
      const Eigen::Vector3d colour = coloured(0.5 + 0.5 * x.x() * x.y()).cast<double>();
      bright->integrate(one_sample(0, x, colour));
      dark->integrate(one_sample(0, x, 0.5 * colour));
    }
    const auto& a = dynamic_cast<const LightFieldModel&>(bright->light_field());
    const auto& b = dynamic_cast<const LightFieldModel&>(dark->light_field());
    for (std::size_t i = 0; i < a.coefficients().size(); ++i) {
      // Halves below the normal range lose bits.
      EXPECT_NEAR(0.5f * static_cast<float>(a.coefficients()[i]),
                  static_cast<float>(b.coefficients()[i]), 1e-7f)
          << i;
    }
  }
}

// One, two, repeated and collinear samples, samples on and outside the rim, numbers that are none.
TEST(SphericalHarmonics, DegenerateSamplesAreFinite) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const std::vector<std::vector<Eigen::Vector2d>> sets{
      {{0, 0}},
      {{1, 0}, {1, 0}, {1, 0}},
      {{0.3, 0.3}, {0.3, 0.3 + 1e-7}},
      {{-0.9, 0}, {-0.3, 0}, {0, 0}, {0.2, 0}, {0.8, 0}},
      {{3, 4}, {-2, 0}}};
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    for (const auto& set : sets) {
      const auto fitted = make({degree, 0.01});
      double level = 0.2;
      for (const Eigen::Vector2d& x : set) {
        fitted->integrate(one_sample(0, x, Eigen::Vector3d::Constant(level)));
        level = 1 - level;
        fitted->integrate(one_sample(0, {nan, 0}, {0.5, 0.5, 0.5}));
        fitted->integrate(one_sample(0, {0, 0}, {infinity, 0.5, 0.5}));
      }
      fitted->finish();
      EXPECT_EQ(fitted->statistics().samples, set.size());
      for (const Eigen::Vector2f& x : fitting::testing::disc_grid(4, 8)) {
        EXPECT_TRUE(fitting::testing::colour_of(fitted->light_field(), 0, x).allFinite());
      }
    }
  }
}

// z^2 has the mean 1/2 over the disc, z 2/3; the others cancel (light_field_model.cpp).
TEST(SphericalHarmonics, MeanColourIsTheMeanOverTheDisc) {
  std::mt19937 random(kSeed);
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    LightFieldModel model(degree, 1);
    std::vector<double> values(3 * term_count(degree));
    for (double& value : values) value = 0.1 * static_cast<double>(random()) / 4294967296.0;
    for (std::size_t channel = 0; channel < 3; ++channel) values[channel] += 1.0;
    model.store(0, values);
    model.store_observed(0, true);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    constexpr int rings = 400;
    constexpr int spokes = 12;
    for (int ring = 0; ring < rings; ++ring) {
      const double radius = std::sqrt((ring + 0.5) / rings);
      for (int spoke = 0; spoke < spokes; ++spoke) {
        const double angle = 2 * kPi * spoke / spokes;
        sum += model
                   .evaluate(0, Eigen::Vector2d(radius * std::cos(angle), radius * std::sin(angle))
                                    .cast<float>())
                   .colour_sum.cast<double>();
      }
    }
    EXPECT_LT((model.mean_colour(0).cast<double>() - sum / (rings * spokes)).cwiseAbs().maxCoeff(),
              1e-4)
        << degree;
  }
}

// 2 patches x 16 terms x 3 channels.
TEST(SphericalHarmonics, CountsEveryStoredNumber) {
  EXPECT_EQ(LightFieldModel(3, 2).coefficient_count(), 2u * 16u * 3u);
}

TEST(SphericalHarmonics, RefusesOptionsOutOfRange) {
  for (const Options& options :
       {Options{0, 0.01}, Options{4, 0.01}, Options{3, 0.0}, Options{3, -1.0}, Options{3, 1e9},
        Options{3, std::numeric_limits<double>::quiet_NaN()}}) {
    EXPECT_THROW(make(options), std::invalid_argument);
  }
}

TEST(SphericalHarmonicsFile, ReadsBackBitByBit) {
  const tests::TemporaryFolder folder;
  const core::Mesh mesh = fitting::testing::octahedron();
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    LightFieldModel model(degree, mesh.positions.size());
    std::vector<double> values(3 * term_count(degree));
    std::mt19937 random(kSeed);
    for (std::size_t patch = 0; patch < model.patch_count(); ++patch) {
      for (double& value : values) value = static_cast<double>(random()) / 4294967296.0 - 0.5;
      model.store(patch, values);
      model.store_observed(patch, patch % 2 == 0);
    }
    write_model(folder / "a.glb", mesh, model);
    const Model read = read_model(folder / "a.glb");
    const auto& copy = dynamic_cast<const LightFieldModel&>(*read.light_field);
    EXPECT_EQ(copy.degree(), degree);
    EXPECT_EQ(copy.observed(), model.observed());
    ASSERT_EQ(copy.coefficients().size(), model.coefficients().size());
    EXPECT_EQ(std::memcmp(copy.coefficients().data(), model.coefficients().data(),
                          model.coefficients().size_bytes()),
              0);
  }
}

TEST(SphericalHarmonicsFile, BrokenPartsAreRefused) {
  const LightFieldModel model(2, 3);
  const ModelPart good = encode_model(model);
  const core::Mesh mesh = fitting::testing::points(3);
  EXPECT_NO_THROW(decode_model(good, mesh));
  for (const nlohmann::json& degree :
       {nlohmann::json(0), nlohmann::json(1), nlohmann::json(3), nlohmann::json(4),
        nlohmann::json(-1), nlohmann::json(2.5), nlohmann::json("2"), nlohmann::json(1e18)}) {
    ModelPart bad = good;
    bad.parameters["degree"] = degree;
    EXPECT_THROW(decode_model(bad, mesh), ModelFault) << degree;
  }
  // 3 patches x 9 terms x 3 channels x 2 bytes: any other length is wrong.
  for (std::size_t length = 0; length < 162; ++length) {
    ModelPart bad = good;
    bad.arrays["coefficients"] = good.arrays.at("coefficients").first(length);
    EXPECT_THROW(decode_model(bad, mesh), ModelFault) << length;
  }
  EXPECT_THROW(decode_model(good, fitting::testing::points(4)), ModelFault);
  EXPECT_THROW(decode_model({}, mesh), ModelFault);
}

}  // namespace
}  // namespace sheen::fitting::spherical_harmonics
