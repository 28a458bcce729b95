// SPDX-License-Identifier: MIT
#include "app/commands/compare.h"

#include "app/commands/billboard_comparison.h"
#include "app/commands/frame_options.h"
#include "app/commands/paper_comparison.h"
#include "app/interrupt.h"
#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"
#include "evaluation/comparison/advice.h"
#include "evaluation/comparison/comparison_files.h"
#include "evaluation/comparison/comparison_tables.h"
#include "evaluation/comparison/measure_candidate.h"
#include "evaluation/comparison/observations.h"

#include <fmt/format.h>

#include <set>

namespace sheen::app {
namespace {

constexpr int kDefaultHoldOut = 5;
constexpr int kLargestHoldOut = 1'000'000;
constexpr int kLeastBillboard_px = 32;
constexpr int kMostBillboard_px = 1024;

using evaluation::Candidate;
using evaluation::Comparison;
using evaluation::Observations;

struct CompareOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path output;
  std::vector<std::string> only;  ///< names of candidates; empty: all
  pipeline::FrameChoice frames;
  bool refine_mesh = false;
  bool paper = false;       ///< the paper's experiments instead of sessions
  bool billboards = false;  ///< those on billboards instead
  BillboardComparison billboard{};
};

/// Counts sessions and candidates as they are done: a session's observations are one step, each
/// candidate on it another. What goes on within a step is shown beside it.
class Steps final : public pipeline::ProgressSink {
 public:
  Steps(const CommandContext& context, std::size_t sessions, std::size_t candidates)
      : bar_(context.progress("comparing", static_cast<int>(sessions * (candidates + 1)))) {}

  void begin(const std::string& what) {
    what_ = what;
    bar_.show(done_, what_);
  }
  void end() { bar_.show(++done_, what_); }

  void progress(const pipeline::StepProgress& step) override {
    throw_if_interrupted();
    bar_.show(done_, fmt::format("{}, {} {}", what_, step.step, step.done));
  }

 private:
  Progress bar_;
  std::string what_;
  int done_ = 0;
};

void compare_on(const Observations& observations, const std::string& session,
                const std::vector<Candidate>& candidates, render::Context& gl,
                const std::filesystem::path& scratch, int threads, Steps& steps,
                Comparison& comparison) {
  const std::size_t first_row = comparison.rows.size();
  for (const Candidate& candidate : candidates) {
    steps.begin(session + ": " + candidate.name);
    try {
      comparison.rows.push_back(
          {session,
           candidate,
           evaluation::measure_candidate(candidate, observations, gl, scratch, threads, steps),
           {}});
    } catch (const core::Error& error) {
      // A model too large for the driver must not take hours of other figures with it.
      if (error.kind() != core::Error::Kind::run_failed) throw;
      comparison.left_out.push_back({session, candidate.name, error.what()});
    }
    steps.end();
  }
  evaluation::mark_fronts(std::span(comparison.rows).subspan(first_row));
}

Comparison compare_sessions(const CompareOptions& options, const CommandContext& context,
                            const std::filesystem::path& scratch) {
  const std::vector<Candidate> candidates = evaluation::candidates_named(options.only);
  const std::vector<std::string> names = evaluation::session_names(options.folders);
  const auto gl = render::make_osmesa_context();
  Comparison comparison;
  Steps steps(context, names.size(), candidates.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    steps.begin(names[i]);
    const Observations observations = evaluation::observe_session(
        options.folders[i], options.frames, options.refine_mesh, context.threads, steps);
    steps.end();
    comparison.sessions.push_back({.name = names[i],
                                   .folder = options.folders[i].string(),
                                   .fitted_frames = observations.views.size(),
                                   .held_out_views = observations.held_out.size(),
                                   .has_own_held_out = observations.has_own_held_out});
    compare_on(observations, names[i], candidates, *gl, scratch, context.threads, steps,
               comparison);
  }
  return comparison;
}

void check_was_measured(const Comparison& comparison) {
  if (!comparison.rows.empty()) return;
  const evaluation::LeftOutCandidate& first = comparison.left_out.front();
  throw core::Error(core::Error::Kind::run_failed, first.session, "no candidate could be measured",
                    first.reason);
}

/// Learns what may be wrong with the sessions before the long work.
void check_sessions(const std::vector<std::filesystem::path>& folders,
                    const CommandContext& context) {
  std::set<std::filesystem::path> seen;
  for (const auto& folder : folders) {
    const capture::Session session = capture::open_session(folder);
    for (const std::string& warning : session.warnings) context.note("note: " + warning);
    if (!seen.insert(std::filesystem::weakly_canonical(folder)).second) {
      throw core::bad_input(folder, "is given twice", "name every session once");
    }
  }
}

void run_compare(const CompareOptions& options, const CommandContext& context) {
  if (options.paper) {
    compare_with_paper(options.output, context);
    return;
  }
  if (options.billboards) {
    compare_billboards(options.billboard, options.output, context);
    return;
  }
  context.check_outputs({});
  check_sessions(options.folders, context);
  const core::StagedOutput staging(options.output / "comparison");
  std::filesystem::create_directory(staging.path());

  // Measure.
  const Comparison comparison = compare_sessions(options, context, staging.path() / "scratch.glb");
  check_was_measured(comparison);

  // Write and tell.
  const auto advice =
      evaluation::advise(evaluation::averages(comparison), comparison.sessions.size());
  const nlohmann::ordered_json document = to_json(comparison, advice);
  const evaluation::ComparisonFiles files =
      evaluation::write_comparison(options.output, staging.path(), to_csv(comparison), document);
  for (const std::string& note : files.notes) context.note("note: " + note);
  std::string text = to_text(comparison);
  for (const auto& path : files.written) text += "written  " + path.string() + "\n";
  if (advice) text += "\n" + advice->sentence + "\n";
  context.publish(document, text);
}

}  // namespace

void add_compare_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<CompareOptions>();
  options->frames.hold_out = kDefaultHoldOut;
  Command command = program.command(
      "compare", "Measure every representation on the same recordings: accuracy, time, bytes");
  command.example(
      "All candidates take the same samples and are drawn on the same views that none has seen:\n"
      "SESSION/held_out where there is one, else every N-th frame. DIR receives compare.csv,\n"
      "charts (PNG, SVG) and compare.html, a page that needs no network.\n"
      "Example:\n  sheen compare sample_data/glossy -o comparison --only mean,sh3,quadtree");
  Option sessions =
      command.option("sessions", options->folders, "Session folders").type("SESSION...");
  const Option paper =
      command
          .flag("--paper", options->paper,
                "Instead of sessions: the paper's own experiments, beside its figures")
          .excludes(sessions);
  const Option billboards =
      command
          .flag("--billboards", options->billboards,
                "Instead of sessions: how frames of billboards should be baked, beside a paper's "
                "figures (docs/systems.md)")
          .excludes(sessions)
          .excludes(paper);
  const Option object = command
                            .option("--object", options->billboard.mesh,
                                    "With --billboards: a mesh instead of a knot")
                            .type("FILE");
  const Option image_size = command
                                .option("--image-size", options->billboard.side_px,
                                        "With --billboards: side of frames and images, pixels")
                                .range(kLeastBillboard_px, kMostBillboard_px)
                                .type("N")
                                .show_default();
  command.after_parsing([sessions, paper, billboards, object, image_size] {
    if (!billboards.is_given() && (object.is_given() || image_size.is_given())) {
      throw UsageError("--object and --image-size are of --billboards");
    }
    if (!sessions.is_given() && !paper.is_given() && !billboards.is_given()) {
      throw UsageError("sessions is required");
    }
  });
  command.option("-o,--output", options->output, "Folder to write to").required().type("DIR");
  command
      .option("--only", options->only,
              fmt::format("Only these of {}", fmt::join(evaluation::candidate_names(), ", ")))
      .separated_by(',')
      .one_of(evaluation::candidate_names())
      .type("NAME,NAME");
  command
      .option("--hold-out", options->frames.hold_out,
              "Keep every N-th frame out of the fits and measure on those")
      .range(2, kLargestHoldOut)
      .type("N")
      .show_default();
  command.flag(
      "--refine-mesh", options->refine_mesh,
      "Move the meshes' vertices first as sheen replay does where their print confirms it, "
      "and compare where the refined meshes are seen");
  add_frame_options(command, options->frames);
  add_common_options(command, context);
  command.action([options, &context] { run_compare(*options, context); });
}

}  // namespace sheen::app
