// SPDX-License-Identifier: MIT
#include "fitting/undo/undoable_fitter.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

namespace sheen::fitting {
namespace {

constexpr std::size_t kPatches = 300;

class Undo : public ::testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<PatchFitter> make() { return make_isolated_patches(GetParam(), kPatches); }
};

TEST_P(Undo, ModelEqualsOneThatNeverSawTheUndoneViews) {
  std::mt19937 random(3);
  std::vector<core::SampleBatch> views;
  for (int i = 0; i < 30; ++i) views.push_back(testing::random_view(kPatches, random));

  // One sees 20 views, takes 8 back and sees 10 more; the other sees 12 and the same 10.
  UndoableFitter undone(make);
  const auto never_saw = make();
  for (int i = 0; i < 20; ++i) undone.integrate(testing::observation_of(views[i]));
  undone.undo(8, [](const core::SampleBatch&, const LightField&) {});
  for (int i = 0; i < 12; ++i) never_saw->integrate(views[i]);
  EXPECT_EQ(testing::bytes_of(undone.light_field()), testing::bytes_of(never_saw->light_field()));
  for (int i = 20; i < 30; ++i) {
    undone.integrate(testing::observation_of(views[i]));
    never_saw->integrate(views[i]);
  }
  EXPECT_EQ(testing::bytes_of(undone.light_field()), testing::bytes_of(never_saw->light_field()));
  undone.finish();
  never_saw->finish();
  EXPECT_EQ(testing::bytes_of(undone.light_field()), testing::bytes_of(never_saw->light_field()));
  EXPECT_EQ(undone.statistics().samples, never_saw->statistics().samples);
}

TEST_P(Undo, TakingEverythingBackLeavesAnEmptyModel) {
  std::mt19937 random(4);
  UndoableFitter fitter(make);
  const std::string empty = testing::bytes_of(fitter.light_field());
  for (int i = 0; i < 3; ++i) {
    fitter.integrate(testing::observation_of(testing::random_view(kPatches, random)));
  }
  EXPECT_NE(testing::bytes_of(fitter.light_field()), empty);
  fitter.undo(100, [](const core::SampleBatch&, const LightField&) {});
  EXPECT_EQ(testing::bytes_of(fitter.light_field()), empty);
  EXPECT_EQ(fitter.statistics().samples, 0u);
}

INSTANTIATE_TEST_SUITE_P(EveryRepresentation, Undo,
                         ::testing::ValuesIn(testing::representation_names()),
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
    views.push_back(i == 2 ? core::SampleBatch{} : testing::random_view(kPatches, random));
    log.append(views.back());
  }
  log.truncate(4);
  views[4] = testing::random_view(kPatches, random);
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
