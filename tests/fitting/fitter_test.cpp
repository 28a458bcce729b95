// SPDX-License-Identifier: MIT
#include "fitting/fitter.h"

#include "fitting/model_file/model_codec.h"
#include "fitting/nearest_views/light_field_model.h"
#include "fitting/sparse/light_field_model.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace sheen::fitting {
namespace {

constexpr std::size_t kPatches = 3000;

// What a model holds of each patch.
std::vector<std::string> patches_of(const LightField& light_field) {
  std::vector<std::string> patches(kPatches);
  if (const auto* model = dynamic_cast<const sparse::LightFieldModel*>(&light_field)) {
    for (std::size_t i = 0; i < kPatches; ++i) {
      const sparse::PatchModel patch = model->patch(i);
      patches[i].append(reinterpret_cast<const char*>(patch.atom.data()), patch.rbf_count);
      patches[i].append(reinterpret_cast<const char*>(patch.coefficient.data()),
                        patch.term_count() * sizeof(patch.coefficient[0]));
    }
    return patches;
  }
  if (const auto* model = dynamic_cast<const nearest_views::LightFieldModel*>(&light_field)) {
    for (std::size_t i = 0; i < kPatches; ++i) {
      const auto bytes = std::as_bytes(model->samples(i));
      patches[i].assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
    return patches;
  }
  // All others keep the same number of bytes for every patch, in front of the observed flags.
  const std::string all = testing::bytes_of(light_field);
  const std::size_t flags = all.size() - kPatches;
  const std::size_t stride = flags / kPatches;
  for (std::size_t i = 0; i < kPatches; ++i) {
    patches[i] = all.substr(i * stride, stride) + all[flags + i];
  }
  return patches;
}

std::vector<FitOptions> candidates(int threads) {
  std::vector<FitOptions> options;
  for (const auto construction : testing::kConstructions) {
    for (const bool faithful : {false, true}) {
      options.push_back({{construction, iwls::Layout::disk, 16, 3, faithful}, threads});
    }
  }
  return options;
}

TEST(Representation, ThreadsDoNotChangeTheResult) {
  const unsigned seed = 61;
  for (const std::string& name : representation_names()) {
    for (std::size_t i = 0; i < candidates(1).size(); ++i) {
      std::map<int, std::string> models;
      std::map<int, std::size_t> fits;
      std::map<int, std::vector<std::uint32_t>> updates;
      for (const int threads : {1, 2, 8}) {
        std::mt19937 random(seed);
        const auto fitter = make_fitter(name, testing::isolated(kPatches), candidates(threads)[i]);
        for (int view = 0; view < 20; ++view) {
          updates[threads] = fitter->integrate(testing::random_view(kPatches, random)).patches;
        }
        fitter->finish();
        models[threads] = testing::bytes_of(fitter->light_field());
        fits[threads] = fitter->statistics().fits;
      }
      for (const int threads : {2, 8}) {
        EXPECT_TRUE(models[threads] == models[1]) << name << " " << threads;
        EXPECT_EQ(fits[threads], fits[1]);
        EXPECT_EQ(updates[threads], updates[1]);
      }
    }
  }
}

// The update is the exact difference of the models before and after, flags included.
TEST(Representation, UpdatesListExactlyWhatChanged) {
  for (const std::string& name : representation_names()) {
    for (const FitOptions& options : candidates(1)) {
      std::mt19937 random(62);
      const auto fitter = make_fitter(name, testing::isolated(kPatches), options);
      const LightField& model = fitter->light_field();
      std::vector<std::string> before = patches_of(model);
      std::vector<std::uint8_t> observed_before = model.observed();
      const auto expect_exact = [&](const ModelUpdate& update) {
        const std::vector<std::string> after = patches_of(model);
        std::vector<std::uint32_t> changed;
        for (std::uint32_t patch = 0; patch < kPatches; ++patch) {
          if (after[patch] != before[patch] || model.observed()[patch] != observed_before[patch]) {
            changed.push_back(patch);
          }
        }
        EXPECT_EQ(update.patches, changed) << name;
        before = after;
        observed_before = model.observed();
      };
      for (int view = 0; view < 6; ++view)
        expect_exact(fitter->integrate(testing::random_view(kPatches, random)));
      expect_exact(fitter->finish());
      expect_exact(fitter->integrate(testing::random_view(kPatches, random)));
      expect_exact(fitter->finish());
      // Nothing new: nothing changes.
      EXPECT_TRUE(fitter->finish().patches.empty());
    }
  }
}

TEST(Fitter, BatchChangesInFinishOnly) {
  const auto batch =
      testing::make_iwls({iwls::Construction::batch, iwls::Layout::grid, 16, 3, false});
  EXPECT_TRUE(batch->integrate(testing::one_sample(0, {0, 0}, {1, 0, 0})).patches.empty());
  EXPECT_EQ(batch->light_field().observed()[0], 0);
  EXPECT_EQ(batch->finish().patches, std::vector<std::uint32_t>{0});
  EXPECT_EQ(batch->light_field().observed()[0], 1);
}

TEST(Fitter, MeanIsTheMean) {
  const auto mean = make_fitter("mean", testing::isolated(1), {});
  mean->integrate(testing::one_sample(0, {0.9, 0}, {0.25, 0.5, 1.0}));
  mean->integrate(testing::one_sample(0, {-0.9, 0}, {0.75, 0.5, 0.0}));
  mean->finish();
  EXPECT_EQ(mean->light_field().mean_colour(0), Eigen::Vector3f(0.5f, 0.5f, 0.5f));
  EXPECT_EQ(mean->light_field().evaluate(0, {0.3f, 0.3f}).weight_sum, 1.0f);
  EXPECT_EQ(mean->light_field().coefficient_count(), 3u);
}

// 2 patches x 16 centres x 3 terms x 3 channels.
TEST(Fitter, CountsEveryStoredNumber) {
  const auto iwls = testing::make_iwls({}, 2);
  EXPECT_EQ(iwls->light_field().coefficient_count(), 2u * 16u * 3u * 3u);
}

TEST(Registry, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(representation_names().front(), "iwls");
  EXPECT_THROW(make_fitter("nonsense", testing::isolated(1), {}), std::invalid_argument);
  for (const iwls::Options& options :
       {iwls::Options{{}, {}, 17, 3, false}, iwls::Options{{}, {}, 16, 2, false},
        iwls::Options{{}, {}, 16, 6, true}}) {
    EXPECT_THROW(make_fitter("iwls", testing::isolated(1), {options, 1}), std::invalid_argument);
  }
  EXPECT_THROW(make_fitter("mean", testing::isolated(1), {{}, 0}), std::invalid_argument);
}

TEST(Options, NamesAndEnumeratorsAreInverse) {
  for (const auto construction : testing::kConstructions) {
    EXPECT_EQ(iwls::construction_named(iwls::name_of(construction)), construction);
  }
  for (const auto layout : testing::kLayouts) {
    EXPECT_EQ(iwls::layout_named(iwls::name_of(layout)), layout);
  }
  EXPECT_FALSE(iwls::layout_named("hexagons"));
}

}  // namespace
}  // namespace sheen::fitting
