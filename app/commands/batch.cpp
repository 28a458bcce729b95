// SPDX-License-Identifier: MIT
#include "app/commands/batch.h"

#include "app/batch/batch_page.h"
#include "app/batch/batch_summary.h"
#include "app/batch/jobs_file.h"
#include "app/batch/local_engine.h"
#include "app/batch/slurm_engine.h"
#include "core/diagnostics/error.h"
#include "core/files/write_file.h"
#include "core/text/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sheen::app {
namespace {

struct BatchOptions {
  std::filesystem::path jobs_file;
  std::filesystem::path output;
  std::vector<std::string> only;
  std::optional<int> number;
  std::optional<int> part;
  bool on_slurm = false;
  std::vector<std::string> sbatch_words;
  LocalEngine local;
};

/// Those that were asked for, of all.
void choose(const std::vector<std::string>& only, std::optional<int> number,
            const std::filesystem::path& file, Jobs& jobs) {
  if (number) {
    if (static_cast<std::size_t>(*number) >= jobs.jobs.size()) {
      throw core::bad_input(file, fmt::format("names {} sessions", jobs.jobs.size()),
                            "give a --number below that");
    }
    jobs.jobs = {jobs.jobs.at(static_cast<std::size_t>(*number))};
    return;
  }
  for (const std::string& name : only) {
    const auto is_it = [&name](const Job& job) { return job.name == name; };
    if (std::none_of(jobs.jobs.begin(), jobs.jobs.end(), is_it)) {
      throw core::bad_input(file, "names no session \"" + core::quotable(name) + "\"",
                            "give --only names that it holds");
    }
  }
  if (only.empty()) return;
  std::erase_if(jobs.jobs, [&only](const Job& job) {
    return std::find(only.begin(), only.end(), job.name) == only.end();
  });
}

/// A part of the one session; nothing where it has no such part.
std::vector<SessionWork> part_of(const SessionWork& session, int number) {
  auto parts = session.parts();
  if (static_cast<std::size_t>(number) > parts.size()) return {};
  return {std::move(parts[static_cast<std::size_t>(number) - 1])};
}

void run_batch(const BatchOptions& options, const CommandContext& context) {
  // Read what is to be done.
  Jobs jobs = read_jobs(options.jobs_file);
  choose(options.only, options.number, options.jobs_file, jobs);
  context.check_outputs({options.output / "batch.html"});
  std::vector<SessionWork> sessions;
  for (const Job& job : jobs.jobs) sessions.emplace_back(jobs, job, options.output / job.name);
  if (options.part) sessions = part_of(sessions.front(), *options.part);

  // Do it.
  const Failures failures = options.on_slurm
                                ? run_on_slurm(sessions,
                                               {options.jobs_file, options.output,
                                                options.sbatch_words, options.local.until},
                                               context)
                                : run_locally(sessions, options.local, context);

  // Tell. A page of some sessions would hide the others.
  const nlohmann::ordered_json summary = summarise_batch(jobs, sessions, failures);
  std::string text = batch_text(summary);
  if (options.only.empty() && !options.number) {
    const auto page = options.output / "batch.html";
    core::write_file(page, batch_page(summary));
    text += "\nwritten  " + page.string() + "\n";
  }
  context.publish(summary, text);
  if (!failures.empty()) {
    throw core::Error(core::Error::Kind::run_failed, options.jobs_file,
                      fmt::format("{} of {} sessions failed", failures.size(), sessions.size()),
                      "see failed.log in their folders; the same command tries them again");
  }
}

}  // namespace

void add_batch_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<BatchOptions>();
  Command command = program.command("batch", "Run all steps over many sessions");
  command.example(
      "JOBS.yaml names sessions and what is done with them (docs/batch.md):\n"
      "  steps: [survey, register, replay, evaluate, export]\n"
      "  sessions: [walks/vase, walks/bowl, monday/*]\n"
      "Finished steps are not run again unless their input has changed; a session that fails\n"
      "stops no other; after Ctrl-C or a crash the same command goes on. DIR receives a folder\n"
      "for every session and batch.html: which need another walk, and where.\n"
      "Example:\n  sheen batch JOBS.yaml -o objects --jobs 4");
  command.option("jobs", options->jobs_file, "What to do").required().type("JOBS.yaml");
  command.option("-o,--output", options->output, "Folder to write to").required().type("DIR");
  command
      .option("--jobs", options->local.sessions_at_once,
              "Sessions at once; they share the --threads")
      .range(1, 1000)
      .type("N")
      .show_default();
  std::vector<std::pair<std::string, Step>> steps;
  for (const Step step : kAllSteps) steps.emplace_back(name_of(step), step);
  command.choice("--until", options->local.until, steps, "The last step to run");
  Option only =
      command.option("--only", options->only, "Only sessions of these names; no page is written")
          .separated_by(',')
          .type("NAME,NAME");
  const Option number = command
                            .option("--number", options->number,
                                    "Only this session, counted from 0; no page is written")
                            .not_negative()
                            .type("K");
  only.excludes(number);
  const Option part = command
                          .option("--part", options->part,
                                  "With --number: only this part of its replay, counted from 1")
                          .range(1, 100)
                          .type("N");
  command.after_parsing([number, part] {
    if (part.is_given() && !number.is_given()) throw UsageError("--part asks for --number");
  });
  Option engine =
      command.choice<bool>("--engine", options->on_slurm, {{"local", false}, {"slurm", true}},
                           "local: processes on this machine; slurm: job arrays by sbatch");
  command
      .option("--sbatch", options->sbatch_words,
              "With --engine slurm: an option for sbatch, may be given several times "
              "(--sbatch=--cpus-per-task=4)")
      .type("WORD");
  engine.excludes(only).excludes(number);
  add_common_options(command, context);
  command.action([options, &context] { run_batch(*options, context); });
}

}  // namespace sheen::app
