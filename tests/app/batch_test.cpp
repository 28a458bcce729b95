// SPDX-License-Identifier: MIT
// `sheen batch`: the same models as the commands one by one; what is finished is not run again,
// what has changed is; a broken session stops no other; an interrupted or killed run leaves a state
// from which the same command goes on.
#include "core/diagnostics/error.h"
#include "core/files/folder_lock.h"
#include "tests/app/copied_session.h"

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <map>

namespace sheen::tests {
namespace {

namespace fs = std::filesystem;

class Batch : public CopiedSession {
 protected:
  Batch() : output_(folder_.path() / "out") {}

  fs::path jobs(const std::string& text) const { return folder_.write("jobs.yaml", text); }

  ProgramRun batch(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"batch",  folder_.path() / "jobs.yaml", "-o", output_, "--json",
                                   "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return run_sheen(words);
  }

  nlohmann::json session(const ProgramRun& run, const std::string& name) const {
    const nlohmann::json document = run.json();
    for (const auto& entry : document.at("sessions")) {
      if (entry.at("name") == name) return entry;
    }
    throw std::runtime_error("no session " + name);
  }

  /// When the outputs of a step were moved into place.
  fs::file_time_type time_of(const std::string& step) const {
    return fs::last_write_time(output_ / "session" / step / "step.json");
  }

  void expect_no_unfinished_output() const {
    for (const auto& entry : fs::recursive_directory_iterator(output_)) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(name.front() != '.' || name == ".links") << entry.path();
    }
  }

  fs::path output_;
};

TEST_F(Batch, MakesWhatTheCommandsMake) {
  jobs(
      "sessions: [session]\nhold_out: 4\n"
      "options: {survey: --end 24, register: --end 24, evaluate: --end 24,\n"
      "          replay: --representation mean --end 24}\n");
  const ProgramRun run = batch();
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const auto made = output_ / "session";

  // The recording lies as it lay; the board and the place that were found stand beside it.
  EXPECT_EQ(read_file(session_ / "session.json"), read_file(sample_session() / "session.json"));
  EXPECT_NE(read_file(made / "survey/session/board.yaml"), read_file(session_ / "board.yaml"));
  EXPECT_TRUE(fs::is_symlink(made / "register/session/frames.avi"));
  EXPECT_EQ(read_file(made / "register/session/board.yaml"),
            read_file(made / "survey/session/board.yaml"));

  // The same commands by hand.
  const ProgramRun alone =
      run_sheen({"replay", made / "register/session", "-o", model_, "--hold-out", "4",
                 "--representation", "mean", "--end", "24", "--quiet", "--json"});
  ASSERT_EQ(alone.exit_code, 0) << alone.standard_error;
  EXPECT_EQ(read_file(made / "replay/model.glb"), read_file(model_));
  EXPECT_TRUE(fs::exists(made / "export/model.html"));

  // 24 frames, 6 of them held out (index % 4 == 2); the summary has the reports' figures.
  const auto figures = session(run, "session");
  EXPECT_EQ(figures.at("frames"), 24);
  EXPECT_EQ(figures.at("posed"), 1.0);
  const auto evaluation = nlohmann::json::parse(read_file(made / "evaluate/report.json"));
  EXPECT_EQ(figures.at("psnr"), evaluation.at("mean").at("psnr"));
  EXPECT_EQ(evaluation.at("views").size(), 6U);
  const std::string page = read_file(output_ / "batch.html");
  for (const char* mark : {"{{", " src=", "<link", "@import", "url("}) {
    EXPECT_EQ(page.find(mark), std::string::npos) << mark;
  }
  expect_no_unfinished_output();
}

// Sums over the sectors are sums over all: of patches, of frames, of held-out views.
TEST_F(Batch, SectorsShareOutPatchesAndFrames) {
  const ProgramRun run =
      run_sheen({"replay", session_, "-o", model_, "--hold-out", "4", "--representation", "mean",
                 "--end", "24", "--quiet", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const auto report = run.json();
  const auto& coverage = report.at("coverage");
  std::map<std::string, int> sums{{"patches", coverage.at("underneath").at("patches")},
                                  {"observed", coverage.at("underneath").at("observed")}};
  for (const auto& sector : coverage.at("sectors")) {
    for (const char* key : {"patches", "observed", "frames", "held_out_views"}) {
      sums[key] += sector.at(key).get<int>();
    }
    EXPECT_LE(sector.at("observed"), sector.at("patches"));
    EXPECT_EQ(sector.at("held_out_psnr").is_null(), sector.at("held_out_views") == 0);
  }
  EXPECT_EQ(sums["patches"], report.at("patches"));
  EXPECT_EQ(sums["observed"], report.at("patches_observed"));
  EXPECT_EQ(sums["frames"], report.at("frames").at("posed"));
  EXPECT_EQ(sums["held_out_views"], report.at("frames").at("held_out"));
}

TEST_F(Batch, RunsOnlyWhatIsMissingOrHasChanged) {
  const std::string common =
      "sessions: [session]\nsteps: [replay, export]\n"
      "options: {replay: --representation mean --end 24, export: ";
  jobs(common + "--title one}\n");
  ASSERT_EQ(batch().exit_code, 0);
  const auto replayed = time_of("replay");
  const auto exported = time_of("export");

  // Nothing changed: nothing runs.
  ASSERT_EQ(batch().exit_code, 0);
  EXPECT_EQ(time_of("replay"), replayed);
  EXPECT_EQ(time_of("export"), exported);

  // An option of the last step: only that one.
  jobs(common + "--title two}\n");
  ASSERT_EQ(batch().exit_code, 0);
  EXPECT_EQ(time_of("replay"), replayed);
  EXPECT_GT(time_of("export"), exported);

  // A file of the recording: that step and what follows from it.
  const auto exported_again = time_of("export");
  fs::last_write_time(session_ / "board.yaml", fs::file_time_type::clock::now());
  ASSERT_EQ(batch().exit_code, 0);
  EXPECT_GT(time_of("replay"), replayed);
  EXPECT_GT(time_of("export"), exported_again);
}

// A replay in parts gives the bytes of the undivided one, and the same figures; a part that is
// there is not made again, and none is needed once they are merged.
TEST_F(Batch, PartsGiveTheBytesOfTheWhole) {
  const std::string common =
      "hold_out: 4\nsteps: [replay, evaluate]\n"
      "options: {replay: --representation mean --end 24, evaluate: --end 24}\nsessions:\n";
  jobs(common + "  - {folder: session, name: whole}\n  - {folder: session, parts: 3}\n");
  const ProgramRun run = batch({"--until", "replay"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const auto made = output_ / "session";
  for (const char* name : {"replay/model.glb", "replay/poses.txt"}) {
    EXPECT_EQ(read_file(made / name), read_file(output_ / "whole" / name)) << name;
  }
  auto whole = session(run, "whole");
  const auto merged = session(run, "session");
  EXPECT_EQ(merged.at("parts"), 3);
  for (const char* key : {"frames", "posed", "seen", "patches", "model_bytes", "rejections"}) {
    EXPECT_EQ(merged.at(key), whole.at(key)) << key;
  }
  for (auto& sector : whole.at("sectors")) {  // no part measures held-out views
    sector["held_out_psnr"] = nullptr;
    sector["held_out_views"] = 0;
  }
  EXPECT_EQ(merged.at("sectors"), whole.at("sectors"));

  // The last one is lost: the others stay. Then all are merged and may go.
  const auto time_of_part = [&](int number) {
    return fs::last_write_time(made / ("part-" + std::to_string(number)) / "replay/step.json");
  };
  const auto first = time_of_part(1);
  const auto last = time_of_part(3);
  fs::remove_all(made / "part-3");
  fs::remove_all(made / "replay");
  ASSERT_EQ(batch({"--number", "1", "--part", "3", "--until", "replay"}).exit_code, 0);
  EXPECT_GT(time_of_part(3), last);
  EXPECT_FALSE(fs::exists(made / "replay"));
  ASSERT_EQ(batch().exit_code, 0);
  EXPECT_EQ(time_of_part(1), first);
  EXPECT_EQ(read_file(made / "evaluate/sheet.png"),
            read_file(output_ / "whole/evaluate/sheet.png"));
  fs::remove_all(made / "part-1");
  ASSERT_EQ(batch().exit_code, 0);
  EXPECT_FALSE(fs::exists(made / "part-1"));
  expect_no_unfinished_output();
}

TEST_F(Batch, APartThatFailsIsTold) {
  jobs(
      "sessions: [session]\nsteps: [replay]\nparts: 2\noptions: {replay: --patches detail --end "
      "6}\n");
  const ProgramRun run = batch();
  EXPECT_EQ(run.exit_code, 1);
  const auto told = session(run, "session");
  EXPECT_EQ(told.at("state"), "failed");
  EXPECT_NE(told.at("message").get<std::string>().find("a state holds samples"), std::string::npos);
  EXPECT_EQ(told.at("files").at("failed.log"), "session/part-1/failed.log");
  EXPECT_FALSE(fs::exists(output_ / "session/replay"));
  expect_no_unfinished_output();
}

TEST_F(Batch, AFailingSessionStopsNoOtherAndIsTriedAgain) {
  const auto broken = folder_.path() / "broken";
  fs::copy(session_, broken);
  write_file(broken / "object.ply", "ply\nno mesh at all\n");
  jobs(
      "sessions: [broken, session]\nsteps: [replay]\noptions: {replay: --representation mean --end "
      "24}\n");
  const ProgramRun run = batch({"--jobs", "2"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.standard_error.find("1 of 2 sessions failed"), std::string::npos);
  EXPECT_EQ(session(run, "broken").at("state"), "failed");
  EXPECT_EQ(session(run, "broken").at("failed_step"), "replay");
  EXPECT_NE(session(run, "broken").at("message").get<std::string>().find("object.ply"),
            std::string::npos);
  EXPECT_FALSE(session(run, "session").at("psnr").is_number());  // nothing was to be evaluated
  EXPECT_TRUE(fs::exists(output_ / "session/replay/model.glb"));
  EXPECT_FALSE(fs::exists(output_ / "broken/replay"));
  expect_no_unfinished_output();

  // Mended, it goes on where it failed.
  fs::copy_file(session_ / "object.ply", broken / "object.ply",
                fs::copy_options::overwrite_existing);
  const auto replayed = time_of("replay");
  EXPECT_EQ(batch().exit_code, 0);
  EXPECT_EQ(time_of("replay"), replayed);
  EXPECT_EQ(read_file(output_ / "broken/replay/model.glb"),
            read_file(output_ / "session/replay/model.glb"));
  EXPECT_FALSE(fs::exists(output_ / "broken/failed.json"));
}

/// Waits until something of this name is moved into a folder.
void wait_for_move(int watch, const std::string& name) {
  std::array<char, 4096> bytes{};
  while (const ssize_t count = read(watch, bytes.data(), bytes.size())) {
    if (count < 0) return;
    for (ssize_t at = 0; at < count;) {
      inotify_event event{};
      std::memcpy(&event, bytes.data() + at, sizeof event);
      if (name == bytes.data() + at + sizeof event) return;
      at += static_cast<ssize_t>(sizeof event + event.len);
    }
  }
}

/// Starts a batch and sends it `signal` as soon as session a has its model; how it ended.
int signalled_batch(const fs::path& jobs_file, const fs::path& output, int signal) {
  fs::create_directories(output / "a");
  const int watch = inotify_init1(IN_CLOEXEC);
  inotify_add_watch(watch, (output / "a").c_str(), IN_MOVED_TO);
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stdout);  // NOLINT: its text is not looked at
    std::freopen("/dev/null", "w", stderr);  // NOLINT
    execl(sheen_program(), "sheen", "batch", jobs_file.c_str(), "-o", output.c_str(), "--quiet",
          nullptr);
    _exit(127);
  }
  wait_for_move(watch, "replay");
  close(watch);
  kill(child, signal);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST_F(Batch, GoesOnAfterInterruptAndKill) {
  for (const char* name : {"a", "b", "c", "d"}) fs::copy(session_, folder_.path() / name);
  const auto file = jobs(
      "sessions: [a, b, c, d]\nsteps: [replay, evaluate]\nhold_out: 4\n"
      "options: {replay: --representation mean --end 24, evaluate: --end 24}\n");
  // When the first step stands seven others are left: more time than it takes to be told.
  EXPECT_EQ(signalled_batch(file, output_, SIGINT), 130);
  expect_no_unfinished_output();
  EXPECT_FALSE(fs::exists(output_ / "d/evaluate"));
  fs::remove_all(output_ / "a");
  EXPECT_EQ(signalled_batch(file, output_, SIGKILL), 128 + SIGKILL);

  const auto first = fs::last_write_time(output_ / "a/replay/step.json");
  const ProgramRun run = batch();
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_EQ(fs::last_write_time(output_ / "a/replay/step.json"), first);
  expect_no_unfinished_output();
  for (const char* name : {"b", "c", "d"}) {
    EXPECT_EQ(read_file(output_ / name / "replay/model.glb"),
              read_file(output_ / "a/replay/model.glb"));
  }
}

TEST_F(Batch, ASessionThatAnotherProcessWorksOnIsLeftToIt) {
  jobs("sessions: [session]\nsteps: [replay]\noptions: {replay: --representation mean --end 24}\n");
  {
    const core::FolderLock lock(output_ / "session");
    const ProgramRun run = batch();
    EXPECT_EQ(run.exit_code, 1);
    const std::string message = session(run, "session").at("message");
    EXPECT_NE(message.find("is in use by process " + std::to_string(getpid()) + " on "),
              std::string::npos)
        << message;
    EXPECT_THROW(core::FolderLock(output_ / "session"), core::Error);
  }
  EXPECT_EQ(batch().exit_code, 0);
}

TEST_F(Batch, TakesEverySessionOfAFolderAndOddNames) {
  // Every byte but '/' and the end may stand in a name; the text of reports is UTF-8 all the same.
  const std::string odd = "v\xff \"$(x)\n;";
  fs::create_directories(folder_.path() / "walks");
  fs::copy(session_, folder_.path() / "walks" / odd);
  fs::create_directories(folder_.path() / "walks" / "no session");
  jobs(
      "sessions: ['walks/*']\nsteps: [replay]\noptions: {replay: --representation mean --end "
      "24}\n");
  const ProgramRun run = batch();
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_EQ(run.json().at("sessions").size(), 1U);
  EXPECT_TRUE(fs::exists(output_ / odd / "replay/model.glb"));
}

TEST_F(Batch, RefusesBadFilesWithOneLine) {
  const auto expect_refused = [&](const std::string& text, const std::string& mark) {
    jobs(text);
    const ProgramRun run = batch();
    EXPECT_EQ(run.exit_code, 2) << text;
    EXPECT_NE(run.standard_error.find("jobs.yaml"), std::string::npos) << run.standard_error;
    EXPECT_NE(run.standard_error.find(mark), std::string::npos) << run.standard_error;
    EXPECT_EQ(std::count(run.standard_error.begin(), run.standard_error.end(), '\n'), 1);
  };
  expect_refused("", "keys and values");
  expect_refused("sessions: []", "sessions");
  expect_refused("sessions: [a, [}", "YAML");
  expect_refused("sessions: [a, b/a]", "two sessions");
  expect_refused("sessions: [a]\nstep: [replay]", "unknown key");
  expect_refused("sessions: [a]\nsteps: [replya]", "replya");
  expect_refused("sessions: [a]\nsteps: [export]", "without the replay");
  expect_refused("sessions: [a]\nhold_out: 1", "hold_out");
  expect_refused("sessions: [a]\nhold_out: 0\nsteps: [replay, evaluate]", "hold_out: 0");
  expect_refused("sessions: [a]\nwanted: {seen: 2}", "seen");
  expect_refused("sessions: ['nowhere/*']", "no sessions");
  for (const char* parts : {"0", "101", "2.5", "[2]"}) {
    expect_refused(std::string("sessions: [a]\nparts: ") + parts, "parts");
  }
  EXPECT_EQ(batch({"--engine", "slurm", "--number", "0"}).exit_code, 2);
  EXPECT_EQ(batch({"--part", "1"}).exit_code, 2);
  expect_refused("sessions: [{folder: a, name: ../b}]", "name of a folder");
  EXPECT_FALSE(fs::exists(output_));
}

}  // namespace
}  // namespace sheen::tests
