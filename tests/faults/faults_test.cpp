// SPDX-License-Identifier: MIT
// The disk fills up at every write of every command that writes, and the command is killed before
// every write and every move, and the power fails after every move: afterwards each output is the
// old one or the new one, whole. A command that says it is done has written everything. All of it
// below folders whose names hold every byte (docs/trust.md).
#include "core/text/number.h"
#include "tests/app/program.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <map>
#include <regex>

namespace sheen::tests {
namespace {

namespace fs = std::filesystem;

constexpr int kMostEvents = 2000;

/// Files of a folder (or one file) by name, "" for what is no file.
using Tree = std::map<std::string, std::string>;

Tree tree_of(const fs::path& path) {
  Tree tree;
  if (fs::is_regular_file(path)) tree["."] = read_file(path);
  if (!fs::is_directory(path)) return tree;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) {
      tree[entry.path().lexically_relative(path).string()] = read_file(entry.path());
    }
  }
  return tree;
}

/// Every number as 0.
Tree without_numbers(Tree tree) {
  static const std::regex number(R"(\d[\d.eE+-]*)");
  for (auto& [name, text] : tree) text = std::regex_replace(text, number, "0");
  return tree;
}

/// A command with its outputs below a folder, which OUT in its words stands for. SESSION stands for
/// a small session, OTHER for a copy, MODEL, STATE and DATA_SET for what was made of it, WALK for a
/// session that shows enough to measure a mesh, SAMPLE for the sample session.
struct WritingCommand {
  const char* name;
  std::vector<std::string> words;
  std::vector<std::string> outputs;  ///< that must be equal, byte for byte, to those of a good run
  bool replaces = true;              ///< an old output; else it is refused
  bool is_timed = false;             ///< numbers, which are times, differ from run to run
};

const std::vector<WritingCommand>& commands() {
  static const std::vector<WritingCommand> all{
      {"replay",
       {"replay", "SESSION", "-o", "OUT/model.glb", "--mean-out", "OUT/mean.glb", "--poses-out",
        "OUT/poses.txt", "--patches", "vertex", "--state", "OUT/fit.state", "--report",
        "OUT/report.json"},
       {"model.glb", "mean.glb", "poses.txt", "fit.state"}},
      {"replay_detail",
       {"replay", "SESSION", "-o", "OUT/model.glb", "--patches", "detail"},
       {"model.glb"}},
      {"render",
       {"render", "MODEL", "--views", "SESSION", "-o", "OUT/views"},
       {"views/0000.png", "views/0003.png"}},
      {"evaluate",
       {"evaluate", "MODEL", "SESSION", "--contact-sheet", "OUT/sheet.png", "--report",
        "OUT/report.json"},
       {"sheet.png"}},
      {"export", {"export", "MODEL", "-o", "OUT/model.html"}, {"model.html"}},
      {"merge",
       {"merge", "STATE", "-o", "OUT/model.glb", "--state", "OUT/fit.state"},
       {"model.glb", "fit.state"}},
      {"forget",
       {"forget", "STATE", "--frames", "0-1", "-o", "OUT/model.glb", "--state", "OUT/fit.state"},
       {"model.glb", "fit.state"}},
      {"synth",
       {"synth", "matte", "-o", "OUT/session", "--size", "160x120", "--frames", "2", "--held-out",
        "1", "--samples", "1", "--mesh-vertices", "500"},
       {"session"},
       false},
      {"board", {"board", "-o", "OUT/board.pdf"}, {"board.pdf", "board.yaml"}},
      {"survey", {"survey", "SESSION", "-o", "OUT/board.yaml"}, {"board.yaml"}},
      {"register", {"register", "SESSION", "-o", "OUT/session.json"}, {"session.json"}},
      {"data_set",
       {"export", "SESSION", "-o", "OUT/set", "--format", "nerfstudio"},
       {"set"},
       false},
      {"import",
       {"import", "DATA_SET", "--mesh", "SESSION/object.ply", "-o", "OUT/session"},
       {"session"},
       false},
      {"resume",
       {"resume", "STATE", "OTHER", "-o", "OUT/model.glb", "--state", "OUT/fit.state"},
       {"model.glb", "fit.state"}},
      {"mesh", {"mesh", "WALK", "--end", "8", "-o", "OUT/mesh.ply", "--force"}, {"mesh.ply"}},
      {"calibrate",
       {"calibrate", "SAMPLE", "--board", "SAMPLE/board.yaml", "-o", "OUT/camera.yaml", "--picture",
        "OUT/coverage.png"},
       {"camera.yaml", "coverage.png"}},
      {"compare",
       {"compare", "SESSION", "-o", "OUT/comparison", "--only", "mean"},
       {"comparison/compare.csv", "comparison/compare.html"},
       true,
       true},
  };
  return all;
}

class Faults : public ::testing::TestWithParam<std::size_t> {
 protected:
  static void SetUpTestSuite() {
    made_ = new TemporaryFolder;  // NOLINT: gtest's way of sharing
    run_good({"synth", "matte", "-o", *made_ / "session", "--size", "160x120", "--frames", "6",
              "--held-out", "0", "--samples", "1", "--mesh-vertices", "500", "--quiet"});
    fs::copy(*made_ / "session", *made_ / "other");
    run_good({"replay", *made_ / "session", "-o", *made_ / "model.glb", "--representation", "mean",
              "--state", *made_ / "fit.state", "--quiet"});
    run_good(
        {"export", *made_ / "session", "-o", *made_ / "set", "--format", "nerfstudio", "--quiet"});
  }
  static void TearDownTestSuite() { delete made_; }

  static void run_good(const std::vector<std::string>& words) {
    const ProgramRun run = run_sheen(words);
    ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  }

  /// `fault` is what SHEEN_FAULT says (fail_write.cpp); empty: none.
  ProgramRun run(const fs::path& out, const std::string& fault) const {
    std::vector<std::string> words;
    if (command_.words[1] == "WALK" && !fs::exists(*made_ / "walk")) {
      run_good({"synth", "matte", "-o", *made_ / "walk", "--size", "320x240", "--frames", "12",
                "--held-out", "0", "--samples", "1", "--vertices", "1000", "--quiet"});
    }
    for (std::string word : command_.words) {
      if (word == "OUT") word = out;
      if (word.starts_with("OUT/")) word = out / word.substr(4);
      if (word.starts_with("SESSION")) word = (*made_ / "session").string() + word.substr(7);
      if (word == "OTHER") word = *made_ / "other";
      if (word == "WALK") word = *made_ / "walk";
      if (word.starts_with("SAMPLE")) word = sample_session().string() + word.substr(6);
      if (word == "DATA_SET") word = *made_ / "set";
      if (word == "MODEL") word = *made_ / "model.glb";
      if (word == "STATE") word = *made_ / "fit.state";
      words.push_back(word);
    }
    words.insert(words.end(), {"--quiet", "--threads", "1"});
    if (fault.empty()) return run_sheen(words);
    setenv("LD_PRELOAD", FAIL_WRITE_LIBRARY, 1);
    setenv("SHEEN_FAULT", fault.c_str(), 1);
    ProgramRun result = run_sheen(words);
    unsetenv("LD_PRELOAD");
    unsetenv("SHEEN_FAULT");
    return result;
  }

  /// A folder whose name holds every byte that may stand in one: all but '/' and the end.
  [[nodiscard]] fs::path odd_folder() const {
    std::string name;
    for (int byte = 1; byte < 256; ++byte) {
      if (byte != '/') name += static_cast<char>(byte);
    }
    return folder_ / name.substr(0, 127) / name.substr(127);
  }

  /// What stood there before.
  fs::path make_old(const fs::path& out) const {
    fs::remove_all(out);
    fs::create_directories(out);
    if (!command_.replaces) return out;
    for (const std::string& output : command_.outputs) {
      if (fs::path(output).has_extension()) {
        fs::create_directories((out / output).parent_path());
        write_file(out / output, "old");
      } else {
        fs::create_directories(out / output);
        write_file(out / output / "old.txt", "old");
      }
    }
    return out;
  }

  [[nodiscard]] Tree contents(const fs::path& output) const {
    return command_.is_timed ? without_numbers(tree_of(output)) : tree_of(output);
  }

  void expect_old_or_new(const fs::path& out, const fs::path& old, const fs::path& good,
                         bool is_done) const {
    for (const std::string& output : command_.outputs) {
      const Tree found = contents(out / output);
      const bool is_new = found == contents(good / output);
      // A folder is replaced by two moves, between which there is none; it stands aside then.
      EXPECT_TRUE(is_new || (!is_done && (found == contents(old / output) || found.empty())))
          << output << " is neither the old nor the new one";
      if (fs::path(output).has_extension()) {
        EXPECT_FALSE(found.empty()) << output << " is gone";
      }
    }
  }

  const WritingCommand& command_ = commands().at(GetParam());
  TemporaryFolder folder_;
  static TemporaryFolder* made_;
};

TemporaryFolder* Faults::made_ = nullptr;

// A folder that cannot be written is told before the work begins, in one line that names it.
TEST_P(Faults, OutputsAreOldOrNewWhereverTheDiskIsFull) {
  const auto good = make_old(folder_ / "good");
  const auto old = make_old(folder_ / "old");
  ASSERT_EQ(run(good, "").exit_code, 0) << run(good, "").standard_error;
  const auto shut = make_old(odd_folder());
  const ProgramRun refused = run(shut, "read-only:" + shut.string());
  EXPECT_EQ(refused.exit_code, 2) << refused.standard_error;
  EXPECT_NE(refused.standard_error.find(core::quotable(shut.string(), 1000)), std::string::npos)
      << refused.standard_error;
  EXPECT_EQ(std::count(refused.standard_error.begin(), refused.standard_error.end(), '\n'), 1)
      << refused.standard_error;
  EXPECT_TRUE(tree_of(shut) == tree_of(old));
  for (const char* kind : {"full", "short"}) {
    int n = 1;
    for (; n < kMostEvents; ++n) {
      SCOPED_TRACE(std::string(command_.name) + " " + kind + ":" + std::to_string(n));
      const auto out = make_old(odd_folder());
      const ProgramRun faulty = run(out, std::string(kind) + ":" + std::to_string(n));
      const bool is_done = faulty.exit_code == 0;
      expect_old_or_new(out, old, good, is_done);
      if (is_done) break;
      EXPECT_TRUE(faulty.exit_code == 1 || faulty.exit_code == 2) << faulty.exit_code;
      EXPECT_EQ(std::count(faulty.standard_error.begin(), faulty.standard_error.end(), '\n'), 1)
          << faulty.standard_error;
      for (const auto& entry : fs::recursive_directory_iterator(out)) {
        EXPECT_EQ(entry.path().filename().string().find(".partial-"), std::string::npos)
            << entry.path();
      }
      if (HasFailure()) return;
    }
    EXPECT_LT(n, kMostEvents);
    std::printf("  %s: %s disk at each of %d writes\n", command_.name, kind, n - 1);
  }
}

// When the power fails, what was written and not flushed is gone: contents must reach the disk
// before their name does, else a file of the right name is empty.
TEST_P(Faults, OutputsAreOldOrNewWheneverItIsKilledOrThePowerFails) {
  const auto good = make_old(folder_ / "good");
  const auto old = make_old(folder_ / "old");
  ASSERT_EQ(run(good, "").exit_code, 0);
  // Where another program draws charts a run takes ten times as long as elsewhere.
  const int step = command_.is_timed ? 4 : 1;
  for (const std::string kind : {"kill", "power"}) {
    int n = 1;
    for (; n < kMostEvents; n += step) {
      SCOPED_TRACE(std::string(command_.name) + " " + kind + ":" + std::to_string(n));
      const auto out = make_old(odd_folder());
      const bool is_done = run(out, kind + ":" + std::to_string(n)).exit_code == 0;
      expect_old_or_new(out, old, good, is_done);
      if (is_done) break;
      // The same command then does it all the same.
      if (kind == "kill") {
        EXPECT_EQ(run(out, "").exit_code, 0);
        expect_old_or_new(out, old, good, true);
      }
      if (HasFailure()) return;
    }
    EXPECT_LT(n, kMostEvents);
    std::printf("  %s: %s at %d places\n", command_.name, kind.c_str(), (n - 1) / step);
  }
}

std::string name_of(const ::testing::TestParamInfo<std::size_t>& each) {
  return commands()[each.param].name;
}

INSTANTIATE_TEST_SUITE_P(EveryCommand, Faults, ::testing::Range(std::size_t{0}, commands().size()),
                         name_of);

}  // namespace
}  // namespace sheen::tests
