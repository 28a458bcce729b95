// SPDX-License-Identifier: MIT
// The laws of eigen-textures (docs/systems.md).
#include "fitting/eigen_texture/eigen_texture.h"

#include "fitting/descriptor.h"
#include "fitting/eigen_texture/factors.h"
#include "fitting/eigen_texture/fit_bases.h"
#include "fitting/eigen_texture/view_history.h"
#include "render/context/context.h"
#include "render/eigen_texture/blend_kernels.h"
#include "render/eigen_texture/eigen_paint.h"
#include "render/eigen_texture/eigen_texture_renderer.h"
#include "render/eigen_texture/texture_blender.h"
#include "render/renderer.h"
#include "render/surface/surface_renderer.h"
#include "tests/fitting/photographs_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

namespace sheen::fitting::eigen_texture {
namespace {

using Eigen::MatrixXf;
using render::testing::looking_at_origin;
using testing::Photographs;

MatrixXf random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  return MatrixXf::NullaryExpr(rows, columns, [&] { return normal(random); });
}

// ---- factors ----

TEST(Factors, CanonicalFormKeepsTheProduct) {
  const Factors any{random_matrix(200, 5, 1), random_matrix(30, 5, 2)};
  const Factors form = canonical(any, 10);
  ASSERT_EQ(form.rank(), 5);
  const MatrixXf product = any.basis * any.coefficients.transpose();
  EXPECT_LT((form.basis * form.coefficients.transpose() - product).norm(), 1e-4f * product.norm());
  const MatrixXf covariance = form.coefficients.transpose() * form.coefficients / 30.0f;
  EXPECT_LT((covariance - MatrixXf::Identity(5, 5)).norm(), 1e-4f);
  for (int k = 1; k < 5; ++k) {
    EXPECT_LE(form.basis.col(k).norm(), form.basis.col(k - 1).norm());
    EXPECT_LT(std::abs(form.basis.col(k).dot(form.basis.col(0))), 1e-3f * product.norm());
  }
}

// What has rank 3 is found with half of it unseen; holes filled with the mean (zero) would leave
// about half of the product.
TEST(Factors, HolesDoNotCount) {
  const MatrixXf truth = random_matrix(400, 3, 1) * random_matrix(3, 60, 2) * 10.0f;
  std::mt19937 random(3);
  Deviations seen{truth,
                  MatrixXf::NullaryExpr(400, 60, [&] { return random() % 2 ? 1.0f : 0.0f; })};
  seen.value = (seen.weight.array() > 0).select(truth, MatrixXf::Constant(400, 60, 1e6f));
  const Factors found = factorise(seen, 3, kSweeps, 1);
  EXPECT_LT((found.basis * found.coefficients.transpose() - truth).norm(), 0.01f * truth.norm());
}

// Lengths 4, 3, 2, 1 of luma against 5 times .35: mean squares 16, 9, 4, 1 and 25 * .35 = 8.75.
TEST(Factors, BasesGoToTheChannelThatGainsMost) {
  const auto with_lengths = [](std::vector<float> lengths) {
    Factors factors{MatrixXf::Ones(10, static_cast<int>(lengths.size())), {}};
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      factors.basis.col(static_cast<int>(k)) *= lengths[k];
    }
    return factors;
  };
  const std::array channels{with_lengths({4, 3, 2, 1}), with_lengths({5}), with_lengths({})};
  using Given = std::array<Eigen::Index, 3>;
  EXPECT_EQ(give_out_bases(channels, 2), (Given{2, 0, 0}));
  EXPECT_EQ(give_out_bases(channels, 3), (Given{2, 1, 0}));
  EXPECT_EQ(give_out_bases(channels, 9), (Given{4, 1, 0}));
}

// ---- what is kept of the views ----

/// A view that shows all texels.
std::vector<SeenTexel> whole_view(int texels, const std::function<float(int)>& grey_of) {
  std::vector<SeenTexel> view;
  for (int i = 0; i < texels; ++i) {
    const auto grey = cv::saturate_cast<std::uint8_t>(grey_of(i));
    view.push_back({static_cast<std::uint32_t>(i), {grey, grey, grey}, 255});
  }
  return view;
}

std::size_t observations(const ViewHistory& history) {
  std::size_t count = 0;
  for (const auto& view : history.views()) count += view.size();
  return count;
}

// Nothing is left out before a texel was seen that often; 5,000 texels are sampled (all of them),
// hence eight times as much.
TEST(ViewHistory, LeavesNothingOutBeforeItMust) {
  ViewHistory history(100, 4);
  for (int v = 0; v < 32; ++v) history.add(whole_view(100, [](int i) { return float(i); }));
  EXPECT_EQ(observations(history), 3200u);
}

// Of 9,000 texels in 600 views with 16 each: every second texel is one of the sample and keeps 128.
// What is kept of a kind is a sum of 4,500 * 600 draws whose variance is below their mean; it may
// be an eighth more until all are thinned again. Every view keeps its share: of 36 standard
// deviations squared of a mean of 4,500 (16 + 128) / 600, as old ones do of new ones.
TEST(ViewHistory, KeepsItsShareOfEveryView) {
  constexpr int texels = 9000, views = 600;
  ViewHistory history(texels, 16);
  for (int v = 0; v < views; ++v) history.add(whole_view(texels, [](int i) { return float(i); }));
  std::array<double, 2> kept{};
  for (const auto& view : history.views()) {
    for (const SeenTexel& seen : view) ++kept[seen.slot % 2];
    EXPECT_TRUE(std::ranges::is_sorted(view, {}, &SeenTexel::slot));
    const double share = 4500.0 * (16 + 128) / views;
    EXPECT_GT(view.size(), share - 6 * std::sqrt(share));
    EXPECT_LT(view.size(), 1.125 * share + 6 * std::sqrt(share));
  }
  for (const auto& [count, each] : {std::pair{kept[0], 128.0}, std::pair{kept[1], 16.0}}) {
    EXPECT_GT(count, 4500 * each - 6 * std::sqrt(4500 * each));
    EXPECT_LT(count, 1.125 * (4500 * each + 6 * std::sqrt(4500 * each)));
  }
}

// Grey textures of rank 3 come back from so few observations a texel (16 of up to 700, 128 of those
// sampled), but for the rounding of pictures (.29 grey levels RMS), bases (a 254th of the largest
// deviation) and what noise of .29 leaves in four numbers from 16 observations (half of it). There
// are more views than principal components are sought in.
TEST(ViewHistory, WhatItKeepsSaysAllOfAFewBases) {
  constexpr int texels = 9000, views = 700;
  static_assert(views > kMostFactorised);
  const MatrixXf truth =
      (random_matrix(texels, 3, 1) * random_matrix(3, views, 2) * 12.0f).array() + 128.0f;
  ViewHistory history(texels, 16);
  std::vector<Texel> mean(texels);
  for (int v = 0; v < views; ++v) {
    history.add(whole_view(texels, [&](int i) { return truth(i, v); }));
  }
  for (int i = 0; i < texels; ++i) {
    const auto middle = cv::saturate_cast<std::uint8_t>(truth.row(i).mean());
    mean[static_cast<std::size_t>(i)] = {middle, middle, middle};
  }
  const Channel luma = fit_bases(history.views(), mean, 3, kSweeps, 1)[0];
  ASSERT_EQ(luma.bases, 3u);
  double sum = 0;
  for (int v = 0; v < views; ++v) {
    for (int i = 0; i < texels; ++i) {
      float grey = mean[static_cast<std::size_t>(i)][0];
      for (std::size_t k = 0; k < 3; ++k) {
        grey += static_cast<float>(luma.coefficients[static_cast<std::size_t>(v) * 3 + k]) *
                static_cast<float>(luma.texels[k * texels + static_cast<std::size_t>(i)]);
      }
      sum += std::pow(double(grey - truth(i, v)), 2);
    }
  }
  const double rms = std::sqrt(sum / (double(texels) * views));
  std::printf("RMS %.3f\n", rms);
  EXPECT_LT(rms, 1.0);
}

// ---- kernels ----

// All kernels agree within a grey level, and the sum in whole numbers with one in floats.
TEST(BlendKernels, AgreeWithinAGreyLevel) {
  using namespace render::eigen_texture;
  constexpr std::size_t texels = 5000;
  std::mt19937 random(1);
  for (const std::size_t bases : {1u, 7u, 20u, 100u}) {
    Channel channel{bases, std::vector<std::int8_t>(bases * texels), {}};
    for (auto& one : channel.texels) one = static_cast<std::int8_t>(random() % 255 - 127);
    std::vector<float> coefficients(bases);
    // Together a deviation of about 60 grey levels.
    for (float& one : coefficients) {
      one = std::normal_distribution<float>(0, 0.8f / std::sqrt(float(bases)))(random);
    }
    for (const BlendKernel& kernel : blend_kernels()) {
      BlendedChannel blended(channel, texels, kernel);
      const auto& sums = blended.blend(coefficients);
      for (std::size_t i = 0; i < texels; ++i) {
        float exact = 0;
        for (std::size_t k = 0; k < bases; ++k) {
          exact += coefficients[k] * static_cast<float>(channel.texels[k * texels + i]);
        }
        // Coefficients are within 2^-13: 127 bases^.5 2^-13 / 3^.5 is a tenth at 100 bases, five
        // deviations of it half a grey level; multiply-high rounds every term to a 32nd besides.
        ASSERT_NEAR(static_cast<float>(sums[i]) / (1 << kSumBits), exact, 1.0f) << kernel.name;
      }
    }
  }
}

TEST(BlendKernels, WholeNumbersAreTheSameInEveryLayout) {
  using namespace render::eigen_texture;
  constexpr std::size_t texels = 333, bases = 9;
  std::mt19937 random(1);
  Channel channel{bases, std::vector<std::int8_t>(bases * texels), {}};
  for (auto& one : channel.texels) one = static_cast<std::int8_t>(random() % 255 - 127);
  std::vector<float> coefficients(bases);
  for (float& one : coefficients) one = std::uniform_real_distribution<float>(-1, 1)(random);
  BlendedChannel portable(channel, texels, blend_kernels().back());
  const auto expected = portable.blend(coefficients);
  for (const BlendKernel& kernel : blend_kernels()) {
    if (kernel.name == "multiply-high") continue;  // rounds every term
    BlendedChannel blended(channel, texels, kernel);
    EXPECT_TRUE(std::ranges::equal(blended.blend(coefficients), expected)) << kernel.name;
  }
}

// ---- the whole ----

/// A grey pattern and a highlight that turns with the viewer.
Eigen::Vector3f shiny_print(const Eigen::Vector3f& point, const Eigen::Vector3f& towards_viewer) {
  const Eigen::Vector3f wave = (60.0f * point).array().sin();
  const float shine = std::pow(
      std::max(0.0f,
               point.normalized().dot((towards_viewer + Eigen::Vector3f(0, 0, 1)).normalized())),
      8.0f);
  return {0.35f + 0.2f * wave.x() * wave.y() + 0.4f * shine, 0.35f + 0.4f * shine,
          0.4f + 0.1f * wave.z() + 0.3f * shine};
}

/// The first `held_out` views lie between the others.
Photographs cap_of_photographs(int views, int held_out) {
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < held_out + views; ++i) {
    // A spiral over the cap (golden angle); held-out ones from another one within it.
    const bool out = i < held_out;
    const double part = out ? (i + 0.5) / held_out * 0.6 : (i - held_out + 0.5) / views;
    const double z = 1 - 0.35 * part;
    const double azimuth = 2.39996 * i + (out ? 1 : 0);
    const double r = std::sqrt(1 - z * z);
    poses.push_back(looking_at_origin({r * std::cos(azimuth), r * std::sin(azimuth), z}, 0.36));
  }
  return {render::testing::sphere(0.1f, 12), poses, shiny_print};
}

std::vector<int> views_from(int begin, int end) {
  std::vector<int> views;
  for (int i = begin; i < end; ++i) views.push_back(i);
  return views;
}

std::unique_ptr<Fitter> fitted(const Photographs& photographs, const std::vector<int>& views,
                               const std::string& bases, const std::string& solve = "batch") {
  auto fitter = make_fitter("eigen-texture", photographs.mesh(),
                            {{"bases", bases}, {"texture-side", "128"}, {"eigen-solve", solve}});
  photographs.show(views, *fitter);
  fitter->finish();
  return fitter;
}

/// Mean absolute difference of some views from their photographs, grey levels.
double error_of(const Photographs& photographs, const Fitter& fitter,
                const std::vector<int>& views) {
  const auto context = render::make_osmesa_context();
  const auto renderer = render::make_renderer(*context, photographs.mesh(), fitter.light_field());
  double sum = 0;
  for (const int i : views) {
    const auto& [truth, pose] = photographs.views()[static_cast<std::size_t>(i)];
    const auto drawn = renderer->render(photographs.camera(), pose);
    const cv::Mat inside = render::testing::common_interior(drawn.support, drawn.mask, 4);
    sum += render::testing::difference(drawn.image, truth, inside).mean;
  }
  return sum / static_cast<double>(views.size());
}

// With as many bases as views and no noise every view is explained; what is left is resampling.
TEST(EigenTexture, ErrorFallsWithBasesToTheFloor) {
  constexpr int held_out = 6, views = 40;
  const auto photographs = cap_of_photographs(views, held_out);
  const auto seen = views_from(held_out, held_out + views);
  std::vector<double> unseen_error, seen_error;
  for (const char* const bases : {"0", "3", "10", "30", "120"}) {
    const auto fitter = fitted(photographs, seen, bases);
    unseen_error.push_back(error_of(photographs, *fitter, views_from(0, held_out)));
    seen_error.push_back(error_of(photographs, *fitter, seen));
    RecordProperty(std::string("held_out_") + bases, std::to_string(unseen_error.back()));
    RecordProperty(std::string("seen_") + bases, std::to_string(seen_error.back()));
    std::printf("%s bases: held out %.3f, seen %.3f\n", bases, unseen_error.back(),
                seen_error.back());
  }
  for (std::size_t i = 1; i < unseen_error.size(); ++i) {
    EXPECT_LT(unseen_error[i], 1.02 * unseen_error[i - 1]);
    EXPECT_LT(seen_error[i], 1.02 * seen_error[i - 1]);
  }
  EXPECT_LT(unseen_error[2], 0.5 * unseen_error[0]);
}

// While no texel was seen more often than the incremental fit keeps it, the two are one fit; what
// is shown meanwhile does not change it.
TEST(EigenTexture, IncrementalIsBatchWhileNothingIsLeftOut) {
  constexpr int views = 20;
  const auto photographs = cap_of_photographs(views, 0);
  const auto channels = [&](const char* solve) {
    const auto fitter = fitted(photographs, views_from(0, views), "30", solve);
    return dynamic_cast<const EigenTexture&>(fitter->light_field()).channels();
  };
  const auto batch = channels("batch"), incremental = channels("incremental");
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_GT(batch[c].bases, 0u);
    EXPECT_EQ(batch[c].texels, incremental[c].texels);
    EXPECT_EQ(batch[c].coefficients, incremental[c].coefficients);
  }
}

// Bases can be looked at before the end.
TEST(EigenTexture, IncrementalShowsBasesWhileViewsArrive) {
  const auto photographs = cap_of_photographs(8, 0);
  auto fitter = make_fitter("eigen-texture", photographs.mesh(),
                            {{"texture-side", "128"}, {"eigen-solve", "incremental"}});
  photographs.show(views_from(0, 8), *fitter);
  EXPECT_GT(dynamic_cast<const EigenTexture&>(fitter->light_field()).channels()[0].bases, 0u);
}

// Sums in floats by OpenGL against whole numbers on the CPU. Colours stay within what images hold,
// because screen space clamps after reading between texels. In texture space (as many pixels as
// texels) both round texels, in screen space only the CPU does; the image is rounded after, and
// OSMesa reads textures with 8 bits between two texels, so a few pixels may be two levels apart.
TEST(EigenTexture, OpenGlDrawsTheCpusImage) {
  constexpr int views = 12;
  const auto photographs = cap_of_photographs(views, 0);
  const auto fitter = fitted(photographs, views_from(0, views), "30");
  const auto& model = dynamic_cast<const EigenTexture&>(fitter->light_field());
  const auto context = render::make_osmesa_context();
  const auto cpu = render::make_cpu_eigen_texture_renderer(*context, photographs.mesh(), model, 1);
  const auto gl =
      render::make_painted_renderer(*context, photographs.mesh(), [&](const auto& functions) {
        return render::eigen_texture::make_eigen_paint(functions, model);
      });
  const std::size_t texels = model.used().size();
  for (const int width : {80, 320}) {
    const auto camera = render::testing::plain_camera(width, 3 * width / 4);
    const auto pixels = static_cast<std::size_t>(camera.width_px() * camera.height_px());
    EXPECT_EQ(pixels >= texels, width == 320);  // one size for each space
    for (const double azimuth : {0.3, 2.1}) {
      const auto pose =
          looking_at_origin({0.4 * std::cos(azimuth), 0.4 * std::sin(azimuth), 1}, 0.36);
      const auto expected = cpu->render(camera, pose);
      const auto drawn = gl->render(camera, pose);
      EXPECT_EQ(cv::countNonZero(expected.mask != drawn.mask), 0);
      EXPECT_EQ(cv::countNonZero(expected.support != drawn.support), 0);
      const auto difference = render::testing::difference(expected.image, drawn.image, drawn.mask);
      EXPECT_GT(difference.pixels, pixels / 10);
      EXPECT_LE(difference.largest, width == 320 ? 1 : 2);
      EXPECT_LT(difference.mean, 0.5);
      std::printf("%d pixels wide: mean %.3f, largest %d\n", width, difference.mean,
                  difference.largest);
    }
  }
}

// No colour of the object is black; from behind, which nobody saw, colours of the vertices stand
// in.
TEST(EigenTexture, HolesAreNeverBlack) {
  const auto photographs = cap_of_photographs(12, 0);
  const auto fitter = fitted(photographs, views_from(0, 12), "30");
  const auto context = render::make_osmesa_context();
  const auto renderer = render::make_renderer(*context, photographs.mesh(), fitter->light_field());
  const auto drawn =
      renderer->render(photographs.camera(), looking_at_origin({0.3, 0.4, -0.8}, 0.36));
  cv::Mat dark;
  cv::inRange(drawn.image, cv::Scalar::all(0), cv::Scalar::all(20), dark);
  EXPECT_GT(cv::countNonZero(drawn.mask), 1000);
  EXPECT_EQ(cv::countNonZero(dark & drawn.mask), 0);
}

}  // namespace
}  // namespace sheen::fitting::eigen_texture
