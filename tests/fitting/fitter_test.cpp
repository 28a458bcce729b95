// SPDX-License-Identifier: MIT
#include "fitting/fitter.h"

#include "fitting/mean/mean_fitter.h"
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

/// A representation with settings.
struct Candidate {
  std::string name;
  OptionValues options;
};

/// Every representation as it comes, IWLS in every construction.
std::vector<Candidate> candidates() {
  std::vector<Candidate> all;
  for (const std::string& name : testing::representation_names()) {
    if (name != "iwls") {
      all.push_back({name, {}});
      continue;
    }
    for (const auto construction : testing::kConstructions) {
      for (const bool faithful : {false, true}) {
        all.push_back(
            {name, testing::values_of({construction, iwls::Layout::disk, 16, 3, faithful})});
      }
    }
  }
  return all;
}

TEST(Representation, ThreadsDoNotChangeTheResult) {
  const unsigned seed = 61;
  for (const auto& [name, options] : candidates()) {
    std::map<int, std::string> models;
    std::map<int, std::size_t> fits;
    std::map<int, std::vector<std::uint32_t>> updates;
    for (const int threads : {1, 2, 8}) {
      std::mt19937 random(seed);
      const auto fitter = make_isolated_patches(name, kPatches, options, threads);
      for (int view = 0; view < 20; ++view) {
        updates[threads] = fitter->integrate(testing::random_view(kPatches, random)).elements;
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

// The update is the exact difference of the models before and after, flags included.
TEST(Representation, UpdatesListExactlyWhatChanged) {
  for (const auto& [name, options] : candidates()) {
    std::mt19937 random(62);
    const auto fitter = make_isolated_patches(name, kPatches, options);
    const PatchLightField& model = fitter->light_field();
    std::vector<std::string> before = patches_of(model);
    std::vector<std::uint8_t> observed_before = model.observed();
    const auto expect_exact = [&, &name = name](const ModelUpdate& update) {
      const std::vector<std::string> after = patches_of(model);
      std::vector<std::uint32_t> changed;
      for (std::uint32_t patch = 0; patch < kPatches; ++patch) {
        if (after[patch] != before[patch] || model.observed()[patch] != observed_before[patch]) {
          changed.push_back(patch);
        }
      }
      EXPECT_EQ(update.elements, changed) << name;
      before = after;
      observed_before = model.observed();
    };
    for (int view = 0; view < 6; ++view)
      expect_exact(fitter->integrate(testing::random_view(kPatches, random)));
    expect_exact(fitter->finish());
    expect_exact(fitter->integrate(testing::random_view(kPatches, random)));
    expect_exact(fitter->finish());
    // Nothing new: nothing changes.
    EXPECT_TRUE(fitter->finish().elements.empty());
  }
}

TEST(Fitter, BatchChangesInFinishOnly) {
  const auto batch =
      testing::make_iwls({iwls::Construction::batch, iwls::Layout::grid, 16, 3, false});
  EXPECT_TRUE(batch->integrate(testing::one_sample(0, {0, 0}, {1, 0, 0})).elements.empty());
  EXPECT_EQ(batch->light_field().observed()[0], 0);
  EXPECT_EQ(batch->finish().elements, std::vector<std::uint32_t>{0});
  EXPECT_EQ(batch->light_field().observed()[0], 1);
}

TEST(Fitter, MeanIsTheMean) {
  const auto mean = mean::make_mean_fitter(testing::isolated(1), 1);
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
  EXPECT_EQ(representations().front()->name, "detail");  // the default
  EXPECT_THROW(make_isolated_patches("nonsense", 1), std::invalid_argument);
  for (const iwls::Options& options :
       {iwls::Options{{}, {}, 17, 3, false}, iwls::Options{{}, {}, 16, 2, false},
        iwls::Options{{}, {}, 16, 6, true}}) {
    EXPECT_THROW(testing::make_iwls(options), std::invalid_argument);
  }
  for (const OptionValues& options :
       {OptionValues{{"centers", "17"}}, OptionValues{{"terms", "2"}},
        OptionValues{{"terms", "6"}, {"faithful", "true"}}, OptionValues{{"faithful", "yes"}},
        OptionValues{{"centers", "16 "}}, OptionValues{{"tolerance", "0.1"}}}) {
    EXPECT_THROW(make_isolated_patches("iwls", 1, options), std::invalid_argument)
        << options.begin()->first;
  }
  EXPECT_THROW(make_isolated_patches("mean", 1, {}, 0), std::invalid_argument);
  EXPECT_THROW(register_representation(representation_named("mean")), std::invalid_argument);
}

// Options set from their own text are the same options.
TEST(Options, TextAndValuesAreInverse) {
  for (const int terms : {0, 1, 3, 6}) {
    for (const bool faithful : {false, true}) {
      testing::for_all_options(terms, faithful, [](const iwls::Options& options) {
        iwls::Options copy;
        apply(testing::values_of(options), "iwls", option_table(copy));
        EXPECT_EQ(copy.construction, options.construction);
        EXPECT_EQ(copy.layout, options.layout);
        EXPECT_EQ(copy.centers, options.centers);
        EXPECT_EQ(copy.terms, options.terms);
        EXPECT_EQ(copy.faithful, options.faithful);
      });
    }
  }
  for (const auto layout : testing::kLayouts) {
    EXPECT_EQ(iwls::layout_named(iwls::name_of(layout)), layout);
  }
  EXPECT_FALSE(iwls::layout_named("hexagons"));
}

}  // namespace
}  // namespace sheen::fitting
