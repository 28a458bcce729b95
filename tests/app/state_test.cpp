// SPDX-License-Identifier: MIT
// Fit states by the commands: going on, joining and forgetting give the bytes of one run over the
// frames that are left; a state that was damaged is refused.
#include "core/files/folder_lock.h"
#include "tests/app/copied_session.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <sstream>

namespace sheen::tests {
namespace {

namespace fs = std::filesystem;

/// Frames 0 to 11, 12 to 23 and all 24 of a session, each fitted alone.
class State : public CopiedSession {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }

  ProgramRun replay(const std::string& name, const std::string& start, const std::string& end,
                    const std::vector<std::string>& fit) const {
    std::vector<std::string> words{"replay",  session_,
                                   "-o",      path(name + ".glb"),
                                   "--state", path(name + ".state"),
                                   "--start", start,
                                   "--end",   end,
                                   "--quiet"};
    words.insert(words.end(), fit.begin(), fit.end());
    return run_sheen(words);
  }

  static void expect_done(const ProgramRun& run) {
    ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  }

  std::string bytes(const std::string& name) const { return read_file(path(name)); }
};

std::vector<std::string> split_words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

class EveryFit : public State, public testing::WithParamInterface<const char*> {};

TEST_P(EveryFit, ResumeMergeAndForgetGiveTheBytesOfOneRun) {
  const auto fit = split_words(GetParam());
  // Poses from a file: tags are tracked from frame to frame, so a run that begins later poses its
  // first frames a little differently.
  expect_done(run_sheen({"replay", session_, "-o", path("posed.glb"), "--end", "24", "--poses-out",
                         session_ / "poses.txt", "--representation", "mean", "--quiet"}));
  replace("session.json", "\"board\"", "\"poses\": \"poses.txt\", \"board\"");
  expect_done(replay("first", "0", "12", fit));
  expect_done(replay("second", "12", "24", fit));
  expect_done(replay("whole", "0", "24", fit));

  // Joined, in either order.
  expect_done(run_sheen({"merge", path("second.state"), path("first.state"), "-o",
                         path("merged.glb"), "--state", path("merged.state"), "--quiet"}));
  EXPECT_TRUE(bytes("merged.glb") == bytes("whole.glb"));
  EXPECT_TRUE(bytes("merged.state") == bytes("whole.state"));

  // In shares of the patches; those of one frame in any order.
  auto part = fit;
  part.insert(part.end(), {"--part", "1/3"});
  std::vector<std::string> words{"merge", "-o", path("parted.glb"), "--quiet"};
  for (const std::string number : {"2", "3", "1"}) {
    part.back() = number + "/3";
    expect_done(replay("part" + number, "0", "24", part));
    words.push_back(path("part" + number + ".state"));
  }
  expect_done(run_sheen(words));
  EXPECT_TRUE(bytes("parted.glb") == bytes("whole.glb"));

  // Gone on with; the state is replaced.
  fs::copy_file(path("first.state"), path("growing.state"));
  expect_done(run_sheen({"resume", path("growing.state"), session_, "-o", path("resumed.glb"),
                         "--start", "12", "--end", "24", "--quiet"}));
  EXPECT_TRUE(bytes("resumed.glb") == bytes("whole.glb"));
  EXPECT_TRUE(bytes("growing.state") == bytes("whole.state"));

  // And back: forgetting undoes it.
  expect_done(run_sheen({"forget", path("growing.state"), "--frames", "12-23", "-o",
                         path("forgotten.glb"), "--quiet"}));
  EXPECT_TRUE(bytes("forgotten.glb") == bytes("first.glb"));
  EXPECT_TRUE(bytes("growing.state") == bytes("first.state"));
}

INSTANTIATE_TEST_SUITE_P(States, EveryFit,
                         testing::Values("--representation mean", "--representation sh",
                                         "--fitter quadtree", "--fitter batch", "--fitter adaptive",
                                         "--representation sparse",
                                         "--representation nearest-views"),
                         [](const auto& each) {
                           const std::string text = each.param;
                           std::string name = text.substr(text.rfind(' ') + 1);
                           std::erase(name, '-');
                           return name;
                         });

class OneFit : public State {
 protected:
  void SetUp() override { expect_done(replay("first", "0", "6", {"--representation", "mean"})); }
  void expect_refused(const std::vector<std::string>& words, const std::string& mark) const {
    const ProgramRun run = run_sheen(words);
    EXPECT_EQ(run.exit_code, 2) << run.standard_error;
    EXPECT_NE(run.standard_error.find(mark), std::string::npos) << run.standard_error;
    EXPECT_EQ(std::count(run.standard_error.begin(), run.standard_error.end(), '\n'), 1)
        << run.standard_error;
  }
};

TEST_F(OneFit, RefusesWhatCannotBeJoined) {
  const auto first = path("first.state");
  const auto model = path("model.glb");
  expect_refused({"merge", first, first, "-o", model, "--quiet"}, "holds frame 0");
  expect_refused({"resume", first, session_, "-o", model, "--end", "3", "--quiet"},
                 "holds frame 0");
  expect_refused({"forget", first, "--frames", "7-9", "--quiet"}, "none of these");
  expect_refused({"forget", first, "--frames", "0-9", "--quiet"}, "hold nothing");
  expect_refused({"forget", first, "--frames", "9-7", "--quiet"}, "--frames");
  expect_refused({"forget", first, "--session", "other", "--quiet"}, "no session");
  expect_refused({"forget", first}, "--session");
  expect_refused({"merge", first, session_ / "object.ply", "-o", model, "--quiet"}, "no fit state");
  expect_done(replay("other", "6", "9", {"--representation", "sh"}));
  expect_refused({"merge", first, path("other.state"), "-o", model, "--quiet"}, "other settings");
  expect_refused({"replay", session_, "-o", model, "--patches", "detail", "--end", "6", "--state",
                  path("detail.state"), "--quiet"},
                 "images");
  expect_refused({"replay", session_, "-o", model, "--part", "1/2", "--end", "6", "--quiet"},
                 "--state");
  for (const std::string part : {"0/2", "3/2", "1", "1/", "/2", "1/2/3", "x", "-1/2"}) {
    expect_refused({"replay", session_, "-o", model, "--end", "6", "--state", path("part.state"),
                    "--part=" + part, "--quiet"},
                   "1/3, 2/3 and 3/3");
  }
  EXPECT_FALSE(fs::exists(model));
}

// Two that read one state and replace it would keep the work of the later one alone.
TEST_F(OneFit, WhoeverChangesAStateHasItAlone) {
  const std::string before = bytes("first.state");
  {
    const auto lock = core::FolderLock::of_file(path("first.state"));
    const std::string holder = "is in use by process " + std::to_string(getpid()) + " on ";
    expect_refused({"forget", path("first.state"), "--frames", "0-1", "--quiet"}, holder);
    expect_refused({"resume", path("first.state"), session_, "-o", path("model.glb"), "--start",
                    "6", "--end", "9", "--quiet"},
                   holder);
    // What writes elsewhere only reads it.
    expect_done(run_sheen({"forget", path("first.state"), "--frames", "0-1", "--state",
                           path("other.state"), "--quiet"}));
  }
  EXPECT_TRUE(bytes("first.state") == before);
  expect_done(run_sheen({"forget", path("first.state"), "--frames", "0-1", "--quiet"}));
  EXPECT_TRUE(bytes("first.state") == bytes("other.state"));
}

TEST_F(OneFit, RefusesAnotherMesh) {
  // The lowest bit of the first coordinate.
  std::string mesh = read_file(session_ / "object.ply");
  const std::string mark = "end_header\n";
  char& byte = mesh.at(mesh.find(mark) + mark.size());
  byte = static_cast<char>(byte ^ 1);
  write_file(session_ / "object.ply", mesh);
  expect_refused({"resume", path("first.state"), session_, "-o", path("model.glb"), "--start", "6",
                  "--end", "9", "--quiet"},
                 "another mesh");
}

TEST_F(OneFit, InfoTellsWhatAStateHolds) {
  const ProgramRun run = run_sheen({"info", path("first.state"), "--json"});
  expect_done(run);
  EXPECT_EQ(run.json().at("views"), 6);
  EXPECT_EQ(run.json().at("sessions").at("session").at("last_frame"), 5);
}

}  // namespace
}  // namespace sheen::tests
