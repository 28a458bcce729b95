// SPDX-License-Identifier: MIT
// Fit states: joining is associative and commutative to the last bit, forgetting undoes joining,
// and what is fitted is what a fitter gives that saw these views in their order. A file that was
// cut or altered anywhere is refused.
#include "core/diagnostics/error.h"
#include "fitting/state/level_walks.h"
#include "tests/fitting/samples_for_tests.h"
#include "tests/support/full_disk.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace sheen::fitting {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPatches = 40;

/// Points without triangles: patches without neighbours.
core::Mesh points(std::size_t count) {
  core::Mesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    mesh.positions.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
    mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
  }
  return mesh;
}

void nothing(std::size_t /*views*/) {}

class FitState : public ::testing::Test {
 protected:
  using States = std::vector<std::unique_ptr<StateReader>>;

  /// A state of frames [first, last) of a session, whose samples follow from the name alone.
  fs::path make(const std::string& name, const std::string& session, int first, int last,
                core::PatchShare share = {}) {
    StateWriter writer(folder_ / name, {representation_, {}, points(kPatches), share});
    for (int frame = first; frame < last; ++frame) {
      core::SampleBatch batch = view(session, frame);
      share.keep(kPatches, batch);
      writer.append({session, 7, frame}, batch);
    }
    writer.commit();
    return folder_ / name;
  }

  static core::SampleBatch view(const std::string& session, int frame) {
    std::mt19937 random(static_cast<unsigned>(100 * session.front() + frame));
    return testing::random_view(kPatches, random);
  }

  static States open(const std::vector<fs::path>& paths) {
    States states;
    for (const fs::path& path : paths) states.push_back(std::make_unique<StateReader>(path));
    return states;
  }

  fs::path merge(const std::string& name, const std::vector<fs::path>& paths) {
    const States states = open(paths);
    write_joined(folder_ / name, states, join(states), nothing);
    return folder_ / name;
  }

  static std::string model_of(const fs::path& path) {
    const States states = open({path});
    return testing::bytes_of(
        fit_joined(states, join(states), {}, 1, nothing).fitter->light_field());
  }

  std::string representation_ = "mean";
  tests::TemporaryFolder folder_;
};

TEST_F(FitState, JoiningIsAssociativeAndCommutative) {
  const auto a = make("a", "walk", 0, 5);
  const auto b = make("b", "walk", 5, 9);
  const auto c = make("c", "another", 0, 4);
  const std::string once = tests::read_file(merge("once", {a, b, c}));
  EXPECT_EQ(tests::read_file(merge("left", {merge("ab", {a, b}), c})), once);
  EXPECT_EQ(tests::read_file(merge("right", {a, merge("cb", {c, b})})), once);
  EXPECT_EQ(tests::read_file(merge("other", {merge("ca", {c, a}), b})), once);
  // Frames that interleave, too: the parts of one state.
  EXPECT_EQ(tests::read_file(merge("ba", {b, a})), tests::read_file(make("ab2", "walk", 0, 9)));
}

TEST_F(FitState, SharesOfThePatchesJoinToTheWhole) {
  const auto whole = make("whole", "walk", 0, 4);
  for (const std::uint32_t of : {2U, 3U, 40U}) {
    std::vector<fs::path> parts;
    for (std::uint32_t number = of; number >= 1; --number) {
      parts.push_back(make("part" + std::to_string(number), "walk", 0, 4, {number, of}));
    }
    EXPECT_EQ(tests::read_file(merge("merged", parts)), tests::read_file(whole)) << of;
  }
  // Beside a whole walk.
  const auto other = make("other", "another", 0, 2);
  EXPECT_EQ(tests::read_file(merge(
                "a", {make("1", "walk", 0, 4, {1, 2}), other, make("2", "walk", 0, 4, {2, 2})})),
            tests::read_file(merge("b", {whole, other})));
}

TEST_F(FitState, RefusesSharesThatAreNoWhole) {
  const auto first = make("1", "walk", 0, 4, {1, 3});
  const auto second = make("2", "walk", 0, 4, {2, 3});
  const auto last = make("3", "walk", 0, 4, {3, 3});
  EXPECT_THROW(merge("m", {first, second}), core::Error);
  EXPECT_THROW(merge("m", {first, last}), core::Error);
  EXPECT_THROW(merge("m", {second, last}), core::Error);
  EXPECT_THROW(merge("m", {last}), core::Error);
  EXPECT_THROW(merge("m", {first, second, second, last}), core::Error);
  EXPECT_THROW(merge("m", {first, second, make("4", "walk", 0, 4, {2, 2})}), core::Error);
  EXPECT_THROW(merge("m", {first, second, make("4", "walk", 0, 3, {3, 3})}), core::Error);
  EXPECT_FALSE(fs::exists(folder_ / "m"));
}

TEST_F(FitState, ForgettingUndoesJoining) {
  const auto a = make("a", "walk", 0, 5);
  const auto all = open({merge("all", {a, make("c", "another", 0, 4)})});
  auto views = join(all);
  std::erase_if(views, [&](const JoinedView& view) {
    return all[view.state]->views()[view.view].session == "another";
  });
  write_joined(folder_ / "forgotten", all, views, nothing);
  EXPECT_EQ(tests::read_file(folder_ / "forgotten"), tests::read_file(a));
}

TEST_F(FitState, FitsAsAFitterThatSawTheViews) {
  for (const std::string& name : testing::representation_names()) {
    SCOPED_TRACE(name);
    representation_ = name;
    const auto joined = merge("joined", {make("b", "walk", 3, 6), make("a", "walk", 0, 3)});
    const auto fitter = make_isolated_patches(name, kPatches);
    for (int frame = 0; frame < 6; ++frame) fitter->integrate(view("walk", frame));
    fitter->finish();
    EXPECT_EQ(model_of(joined), testing::bytes_of(fitter->light_field()));
  }
}

TEST_F(FitState, GivesBackWhatItWasGiven) {
  StateReader state(make("a", "w\n\xff\"alk", 2, 5));
  ASSERT_EQ(state.views().size(), 3U);
  EXPECT_EQ(state.views()[1], (StateView{"w\n\xff\"alk", 7, 3}));
  core::SampleBatch batch;
  for (const std::size_t i : {2U, 0U, 1U}) {
    state.read(i, batch);
    const core::SampleBatch expected = view("w", static_cast<int>(2 + i));
    EXPECT_EQ(batch.patch, expected.patch);
    EXPECT_EQ(batch.u, expected.u);
    EXPECT_EQ(batch.b, expected.b);
  }
}

TEST_F(FitState, RefusesWhatWasCutOrAltered) {
  const auto path = make("a", "walk", 0, 2);
  const std::string whole = tests::read_file(path);
  // One in seven, so that all of its kinds of bytes are met; both ends whole.
  for (std::size_t at = 0; at < whole.size(); at += at < 80 || at + 80 > whole.size() ? 1 : 7) {
    EXPECT_THROW(StateReader(folder_.write("cut", whole.substr(0, at))), core::Error) << at;
    std::string altered = whole;
    altered[at] = static_cast<char>(altered[at] ^ (1 << (at % 8)));
    EXPECT_THROW(StateReader(folder_.write("altered", altered)), core::Error) << at;
  }
  EXPECT_THROW(StateReader(folder_.write("longer", whole + '\0')), core::Error);
  EXPECT_THROW(StateReader(folder_ / "nowhere"), core::Error);
  EXPECT_NO_THROW(StateReader(folder_.write("same", whole)));
}

TEST_F(FitState, RefusesViewsTwiceAndOtherFits) {
  const auto a = make("a", "walk", 0, 3);
  EXPECT_THROW(merge("m", {a, make("b", "walk", 2, 4)}), core::Error);
  representation_ = "sh";
  EXPECT_THROW(merge("m", {a, make("c", "walk", 3, 4)}), core::Error);
  EXPECT_FALSE(fs::exists(folder_ / "m"));
}

TEST_F(FitState, OnAFullDiskTheOldStateStays) {
  const auto path = make("a", "walk", 0, 3);
  const std::string before = tests::read_file(path);
  const auto full = before.size() - 1;
  {
    const tests::FullDisk disk(full);
    EXPECT_THROW(make("a", "walk", 0, 4), core::Error);
  }
  EXPECT_EQ(tests::read_file(path), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1);
}

}  // namespace
}  // namespace sheen::fitting
