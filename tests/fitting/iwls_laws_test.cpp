// SPDX-License-Identifier: MIT
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sheen::fitting {
namespace {

using testing::for_all_options;
using testing::make_iwls;
using testing::scattered;
using testing::teach;
using testing::text_of;
using testing::worst_error;

Eigen::Vector3d one_lobe(double u, double v) {
  const double z = std::sqrt(std::max(0.0, 1.0 - u * u - v * v));
  const double lobe = std::pow(std::max(0.0, 0.5 * u + 0.3 * v + 0.81 * z), 12);
  return {0.3 + 0.5 * lobe, 0.2 + 0.1 * u, 0.4 - 0.2 * v * v};
}

// 0.3, 0.55 and 0.8 rounded to a half are off by at most 2^-12 (spacing 2^-11 below 1).
TEST(IwlsLaws, AConstantIsReproduced) {
  const auto truth = [](double, double) { return Eigen::Vector3d(0.3, 0.55, 0.8); };
  for (const int terms : {0, 1, 3, 6}) {
    for_all_options(terms, false, [&](const iwls::Options& options) {
      for (const std::size_t samples : {1, 7, 60}) {
        const auto fitter = make_iwls(options);
        teach(*fitter, scattered(samples, 21), truth);
        EXPECT_LT(worst_error(fitter->light_field(), truth), 1.0 / 4096 + 1e-5) << text_of(options);
      }
    });
  }
  for_all_options(3, true, [&](const iwls::Options& options) {
    const auto fitter = make_iwls(options);
    teach(*fitter, scattered(60, 21), truth);
    EXPECT_LT(worst_error(fitter->light_field(), truth), 1.0 / 4096 + 1e-5) << text_of(options);
  });
}

// Unregularised planes reproduce a plane. A centre's error after rounding is at most 2^-12 for its
// value plus 2^-13 for each slope term (|slope h| < 0.5 times |d| < 1): below 5e-4 together.
TEST(IwlsLaws, FaithfulFitsReproduceALinearLumisphere) {
  const auto truth = [](double u, double v) {
    return Eigen::Vector3d(0.5 + 0.3 * u - 0.1 * v, 0.4 - 0.2 * u, 0.6 + 0.25 * v);
  };
  for_all_options(3, true, [&](const iwls::Options& options) {
    const auto fitter = make_iwls(options);
    teach(*fitter, scattered(400, 22), truth);
    EXPECT_LT(worst_error(fitter->light_field(), truth), 5e-4) << text_of(options);
  });
}

// The ridge shrinks, so a smooth lumisphere is met only nearly - and better with more terms.
TEST(IwlsLaws, RidgeFitsComeCloseAndMoreTermsCloser) {
  for (const auto construction : testing::kConstructions) {
    std::vector<double> errors;
    for (const int terms : {1, 3, 6}) {
      const auto fitter = make_iwls({construction, iwls::Layout::grid, 16, terms, false});
      teach(*fitter, scattered(500, 23), one_lobe);
      double sum = 0;
      const auto directions = scattered(500, 24);
      for (const auto& x : directions) {
        const auto value = testing::colour_of(fitter->light_field(), 0, x.cast<float>());
        sum += (value.cast<double>() - one_lobe(x.x(), x.y())).squaredNorm() / 3;
      }
      errors.push_back(std::sqrt(sum / static_cast<double>(directions.size())));
    }
    EXPECT_LT(errors[1], errors[0]);
    EXPECT_LT(errors[2], errors[1]);
  }
}

// The fit is linear in the colours: f -> gain f + offset maps the model the same way.
TEST(IwlsLaws, GainAndOffsetPassThrough) {
  const double gain = 0.5, offset = 0.25;
  const auto mapped = [&](double u, double v) -> Eigen::Vector3d {
    return gain * one_lobe(u, v) + Eigen::Vector3d::Constant(offset);
  };
  for (const bool faithful : {false, true}) {
    for_all_options(3, faithful, [&](const iwls::Options& options) {
      const auto plain = make_iwls(options);
      const auto changed = make_iwls(options);
      teach(*plain, scattered(80, 25), one_lobe);
      teach(*changed, scattered(80, 25), mapped);
      for (const auto& x : testing::disc_grid(8, 16)) {
        const Eigen::Vector3f expected =
            static_cast<float>(gain) * testing::colour_of(plain->light_field(), 0, x) +
            Eigen::Vector3f::Constant(static_cast<float>(offset));
        const Eigen::Vector3f value = testing::colour_of(changed->light_field(), 0, x);
        // Halves: relative 2^-11 of coefficients that may reach a few units without a ridge.
        EXPECT_LT((value - expected).cwiseAbs().maxCoeff(), faithful ? 1e-2f : 2e-3f)
            << text_of(options);
      }
    });
  }
}

// All constructions are functions of running sums (see adaptive.h, quadtree.h): the order of the
// views only changes rounding, far below a half's last bit or across it.
TEST(IwlsLaws, TheOrderOfViewsDoesNotMatter) {
  for (const bool faithful : {false, true}) {
    for_all_options(3, faithful, [&](const iwls::Options& options) {
      auto directions = scattered(70, 26);
      const auto forwards = make_iwls(options);
      teach(*forwards, directions, one_lobe);
      std::reverse(directions.begin(), directions.end());
      const auto backwards = make_iwls(options);
      teach(*backwards, directions, one_lobe);
      const auto& a = dynamic_cast<const iwls::LightFieldModel&>(forwards->light_field());
      const auto& b = dynamic_cast<const iwls::LightFieldModel&>(backwards->light_field());
      for (std::size_t i = 0; i < a.coefficients().size(); ++i) {
        const float x = static_cast<float>(a.coefficients()[i]);
        const float y = static_cast<float>(b.coefficients()[i]);
        // One unit in the last place of a half.
        ASSERT_LE(std::abs(x - y), std::abs(x) / 1024 + 1e-6f) << text_of(options);
      }
    });
  }
}

}  // namespace
}  // namespace sheen::fitting
