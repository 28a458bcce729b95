// SPDX-License-Identifier: MIT
#include "fitting/model_file/model_codec.h"
#include "fitting/rewind/rewindable_representation.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

namespace sheen::fitting {
namespace {

constexpr std::size_t kPatches = 300;

// A view of a random third of the patches from about one side.
core::SampleBatch random_view(std::mt19937& random) {
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  core::SampleBatch batch;
  const Eigen::Vector2d side(1.4 * unit() - 0.7, 1.4 * unit() - 0.7);
  for (std::uint32_t patch = 0; patch < kPatches; ++patch) {
    if (unit() > 0.33) continue;
    const Eigen::Vector2d x = side + 0.1 * Eigen::Vector2d(unit(), unit());
    testing::add_sample(batch, patch, x, {unit(), 0.5 * x.x() + 0.5, 0.3});
  }
  return batch;
}

// Every bit of a model, as it lies in the model file.
std::string bytes_of(const LightField& light_field) {
  std::string all;
  for (const ModelCodec& codec : model_codecs()) {
    if (codec.representation != light_field.representation()) continue;
    const ModelPart part = codec.encode(light_field);
    for (const auto& [name, bytes] : part.arrays) {
      all.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
  }
  all.append(light_field.observed().begin(), light_field.observed().end());
  return all;
}

class Rewind : public ::testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<Representation> make() {
    return make_representation(GetParam(), testing::isolated(kPatches), {.iwls = {}, .threads = 1});
  }
};

TEST_P(Rewind, ModelEqualsOneThatNeverSawTheUndoneViews) {
  std::mt19937 random(3);
  std::vector<core::SampleBatch> views;
  for (int i = 0; i < 30; ++i) views.push_back(random_view(random));

  // One sees 20 views, takes 8 back and sees 10 more; the other sees 12 and the same 10.
  RewindableRepresentation undone(make);
  const auto never_saw = make();
  for (int i = 0; i < 20; ++i) undone.absorb(views[i]);
  undone.rewind(8, [](const core::SampleBatch&, const LightField&) {});
  for (int i = 0; i < 12; ++i) never_saw->absorb(views[i]);
  EXPECT_EQ(bytes_of(undone.light_field()), bytes_of(never_saw->light_field()));
  for (int i = 20; i < 30; ++i) {
    undone.absorb(views[i]);
    never_saw->absorb(views[i]);
  }
  EXPECT_EQ(bytes_of(undone.light_field()), bytes_of(never_saw->light_field()));
  undone.finish();
  never_saw->finish();
  EXPECT_EQ(bytes_of(undone.light_field()), bytes_of(never_saw->light_field()));
  EXPECT_EQ(undone.statistics().samples, never_saw->statistics().samples);
}

TEST_P(Rewind, TakingEverythingBackLeavesAnEmptyModel) {
  std::mt19937 random(4);
  RewindableRepresentation representation(make);
  const std::string empty = bytes_of(representation.light_field());
  for (int i = 0; i < 3; ++i) representation.absorb(random_view(random));
  EXPECT_NE(bytes_of(representation.light_field()), empty);
  representation.rewind(100, [](const core::SampleBatch&, const LightField&) {});
  EXPECT_EQ(bytes_of(representation.light_field()), empty);
  EXPECT_EQ(representation.statistics().samples, 0u);
}

INSTANTIATE_TEST_SUITE_P(EveryRepresentation, Rewind, ::testing::ValuesIn(representation_names()),
                         [](const auto& each) {
                           std::string name = each.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(SampleLog, GivesBackWhatItWasGiven) {
  std::mt19937 random(5);
  SampleLog log;
  std::vector<core::SampleBatch> views;
  for (int i = 0; i < 5; ++i) {
    views.push_back(i == 2 ? core::SampleBatch{} : random_view(random));
    log.append(views.back());
  }
  log.truncate(4);
  views[4] = random_view(random);
  log.append(views[4]);  // in place of the one forgotten
  core::SampleBatch batch;
  for (std::size_t i = 0; i < views.size(); ++i) {
    log.read(i, batch);
    EXPECT_EQ(batch.patch, views[i].patch);
    EXPECT_EQ(batch.u, views[i].u);
    EXPECT_EQ(batch.b, views[i].b);
  }
}

}  // namespace
}  // namespace sheen::fitting
