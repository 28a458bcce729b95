// SPDX-License-Identifier: MIT
#include "app/batch/slurm_engine.h"

#include "app/batch/child_process.h"
#include "app/interrupt.h"
#include "core/diagnostics/error.h"
#include "core/files/folder_lock.h"
#include "core/files/read_file.h"
#include "core/files/write_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>

#include <algorithm>
#include <optional>
#include <sstream>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

constexpr int kLook_ms = 2000;
constexpr std::size_t kMostAnswerBytes = std::size_t{1} << 20;
constexpr const char* kFolder = ".slurm";  // scripts, logs and the numbers of jobs in the queue

/// A word of a shell's command, whatever bytes it holds.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// What a program of Slurm answers on either stream. Throws core::Error (run_failed) when it fails.
std::string ask(const std::string& program, const std::vector<std::string>& words,
                const fs::path& folder) {
  const fs::path answer = folder / "answer.txt";
  std::error_code ignored;
  fs::remove(answer, ignored);
  ChildProcess child(program, words, answer);
  pollfd handle{child.handle(), POLLIN, 0};
  std::optional<int> code;
  while (!(code = child.exit_code())) poll(&handle, 1, -1);
  const std::string text = core::read_file(answer, kMostAnswerBytes);
  if (*code != 0) {
    throw core::Error(core::Error::Kind::run_failed, program,
                      *code == 127 ? "cannot be run" : text.substr(0, text.find('\n')),
                      "check that this machine may submit jobs (Debian: slurm-client)");
  }
  return text;
}

std::vector<int> numbers_of_unfinished(std::span<const SessionWork> sessions, Step until) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    const auto missing = sessions[i].out_of_date();
    if (!missing.empty() && missing.front() <= until) numbers.push_back(static_cast<int>(i));
  }
  return numbers;
}

/// Steps up to `until` that are still to be done.
int count_missing(std::span<const SessionWork> sessions, Step until) {
  int count = 0;
  for (const SessionWork& work : sessions) {
    for (const Step step : work.out_of_date()) count += step <= until ? 1 : 0;
  }
  return count;
}

/// The steps that any of the sessions takes.
std::vector<Step> steps_of(std::span<const SessionWork> sessions, Step until) {
  std::vector<Step> steps;
  for (const Step step : kAllSteps) {
    const bool is_taken = std::ranges::any_of(sessions, [step](const SessionWork& work) {
      return std::ranges::find(work.steps(), step) != work.steps().end();
    });
    if (is_taken && step <= until) steps.push_back(step);
  }
  return steps;
}

/// The most that any of the sessions is replayed in.
int parts_of(std::span<const SessionWork> sessions) {
  int parts = 1;
  for (const SessionWork& work : sessions) parts = std::max(parts, work.job().parts);
  return parts;
}

/// Why a session, or one of its parts, went no further.
std::optional<Failure> failure_of(const SessionWork& work) {
  if (auto failure = read_failure(work.folder())) return failure;
  for (const SessionWork& part : work.parts()) {
    if (auto failure = read_failure(part.folder())) return failure;
  }
  return std::nullopt;
}

class Queue {
 public:
  explicit Queue(const SlurmEngine& engine)
      : engine_(engine), folder_(fs::absolute(engine.output) / kFolder) {
    fs::create_directories(folder_);
  }

  [[nodiscard]] const fs::path& folder() const { return folder_; }

  /// Jobs of an earlier run that are still queued or running.
  std::vector<std::string> left_over() const {
    std::error_code failure;
    if (!fs::exists(folder_ / "jobs", failure)) return {};
    std::istringstream numbers(core::read_file(folder_ / "jobs", kMostAnswerBytes));
    std::vector<std::string> jobs;
    for (std::string number; numbers >> number;) jobs.push_back(number);
    if (jobs.empty()) return {};
    // A number that Slurm has forgotten is an error to it, so all jobs are asked for.
    std::istringstream queue(ask("squeue", {"--noheader", "--format=%A %F"}, folder_));
    std::vector<std::string> known;
    for (std::string number; queue >> number;) {
      if (std::ranges::find(jobs, number) != jobs.end()) known.push_back(number);
    }
    return known;
  }

  /// Submits an array for every step, each task after that of the step before; the parts of a
  /// replay after that, too, and the replay after all of them.
  std::vector<std::string> submit(const std::vector<Step>& steps, int parts,
                                  const std::vector<int>& numbers) {
    std::vector<std::string> jobs;
    std::vector<std::string> before;
    for (const Step step : steps) {
      std::vector<std::string> beside;
      for (int part = 1; step == Step::replay && parts > 1 && part <= parts; ++part) {
        beside.push_back(submit(step, part, numbers, before, jobs));
      }
      if (!beside.empty()) before = beside;
      before = {submit(step, std::nullopt, numbers, before, jobs)};
    }
    return jobs;
  }

  /// A process that ends when all the jobs have.
  ChildProcess waiting_for(const std::vector<std::string>& jobs) const {
    std::vector<std::string> words{"--wait", "--job-name=sheen-end", "--output=/dev/null",
                                   fmt::format("--dependency=afterany:{}", fmt::join(jobs, ":"))};
    words.insert(words.end(), engine_.words.begin(), engine_.words.end());
    words.insert(words.end(), {"--wrap", "true"});
    return {"sbatch", words, folder_ / "wait.txt"};
  }

 private:
  /// One array, whose tasks follow those of the arrays `before`. Notes its number in `jobs`, too.
  std::string submit(Step step, std::optional<int> part, const std::vector<int>& numbers,
                     const std::vector<std::string>& before, std::vector<std::string>& jobs) const {
    std::string name(name_of(step));
    if (part) name += fmt::format("-{}", *part);
    const fs::path script = folder_ / (name + ".sh");
    core::write_file(script, script_of(step, part));
    std::vector<std::string> words{"--parsable",
                                   "--requeue",
                                   "--kill-on-invalid-dep=yes",
                                   "--job-name=sheen-" + name,
                                   fmt::format("--array={}", fmt::join(numbers, ",")),
                                   "--output=" + (folder_ / "%x-%a.log").string()};
    if (!before.empty()) {
      words.push_back(fmt::format("--dependency=aftercorr:{}", fmt::join(before, ":")));
    }
    words.insert(words.end(), engine_.words.begin(), engine_.words.end());
    words.push_back(script);
    const std::string answer = ask("sbatch", words, folder_);
    jobs.push_back(answer.substr(0, answer.find_first_of(";\n")));
    core::write_file(folder_ / "jobs", fmt::format("{}\n", fmt::join(jobs, "\n")));
    return jobs.back();
  }

  std::string script_of(Step step, std::optional<int> part) const {
    return fmt::format(
        "#!/bin/sh\nexec {} batch {} -o {} --number \"$SLURM_ARRAY_TASK_ID\" --until {}{} "
        "--threads \"${{SLURM_CPUS_PER_TASK:-1}}\"\n",
        quoted(fs::read_symlink("/proc/self/exe").string()),
        quoted(fs::absolute(engine_.jobs_file).string()),
        quoted(fs::absolute(engine_.output).string()), name_of(step),
        part ? fmt::format(" --part {}", *part) : "");
  }

  const SlurmEngine& engine_;
  fs::path folder_;
};

void wait_for_end(ChildProcess end, std::span<const SessionWork> sessions, Step until,
                  const CommandContext& context) {
  const int total = count_missing(sessions, until);
  Progress progress = context.progress("steps", total);
  pollfd handle{end.handle(), POLLIN, 0};
  while (!end.exit_code()) {
    throw_if_interrupted();
    progress.show(total - count_missing(sessions, until), "by Slurm");
    poll(&handle, 1, kLook_ms);
  }
  progress.show(total - count_missing(sessions, until), "by Slurm");
}

}  // namespace

Failures run_on_slurm(std::span<const SessionWork> sessions, const SlurmEngine& engine,
                      const CommandContext& context) {
  const auto numbers = numbers_of_unfinished(sessions, engine.until);
  if (numbers.empty()) return {};
  Queue queue(engine);
  const core::FolderLock lock(queue.folder());
  auto jobs = queue.left_over();
  if (jobs.empty()) {
    jobs = queue.submit(steps_of(sessions, engine.until), parts_of(sessions), numbers);
  } else {
    context.note("note: jobs of an earlier run are still in the queue; waiting for those");
  }
  context.note(fmt::format("note: jobs {}; to end them: scancel {}", fmt::join(jobs, ", "),
                           fmt::join(jobs, " ")));
  wait_for_end(queue.waiting_for(jobs), sessions, engine.until, context);

  // What the tasks left.
  Failures failures;
  for (const SessionWork& work : sessions) {
    if (const auto failure = failure_of(work)) failures[work.job().name] = *failure;
  }
  return failures;
}

}  // namespace sheen::app
