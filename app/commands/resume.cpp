// SPDX-License-Identifier: MIT
#include "app/commands/resume.h"

#include "app/commands/frame_options.h"
#include "app/state/joined_model.h"
#include "app/state/session_states.h"
#include "app/terminal_sink.h"
#include "core/files/folder_lock.h"
#include "core/files/staged_output.h"
#include "pipeline/light/session_light.h"
#include "pipeline/reconstruct.h"
#include "pipeline/session_readout.h"

#include <memory>

namespace sheen::app {
namespace {

// Samples are the same whatever is fitted to them; this costs least.
constexpr const char* kCheapest = "mean";

struct ResumeOptions {
  std::filesystem::path state;
  std::filesystem::path session;
  JoinedOutputs outputs;
  pipeline::FrameChoice frames;
};

/// Writes the state of the session alone.
void observe(const ResumeOptions& options, const fitting::StateHeader& like,
             const std::filesystem::path& path, const CommandContext& context) {
  capture::Session session = capture::open_session(options.session);
  for (const std::string& warning : session.warnings) context.note("note: " + warning);
  TerminalSink sink(context);
  pipeline::complete_readout(session, options.frames, sink);
  pipeline::complete_light(session, options.frames, sink);
  SessionState state(session);
  pipeline::Reconstruction fitted(
      {.session = session, .on_samples = state.listener()},
      {.representation = kCheapest, .frames = options.frames, .threads = context.threads}, sink);
  state.open(path, {like.representation, like.options, fitted.mesh()});
  fitted.run(sink);
  state.commit();
}

void run_resume(ResumeOptions options, const CommandContext& context) {
  if (options.outputs.state.empty()) options.outputs.state = options.state;
  context.check_outputs({options.outputs.model, options.outputs.state});
  // Of two that change one state the second would lose what the first has done.
  const auto lock = core::FolderLock::of_file(options.outputs.state);
  States states;
  states.push_back(std::make_unique<fitting::StateReader>(options.state));
  const core::StagedOutput added(options.outputs.state);
  observe(options, states.front()->header(), added.path(), context);
  states.push_back(std::make_unique<fitting::StateReader>(added.path()));
  write_joined_model(states, fitting::join(states), options.outputs, context);
}

}  // namespace

void add_resume_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<ResumeOptions>();
  Command command = program.command("resume", "Go on with a fit from its state and more frames");
  command.example(
      "The state is replaced by one that holds the new frames, too; the model is that of one fit\n"
      "to all of them. Both sessions use one mesh file.\n"
      "Example:\n"
      "  sheen replay walk -o vase.glb --state vase.state\n"
      "  sheen resume vase.state another-walk -o vase.glb");
  command.option("fit", options->state, "What replay --state wrote").required().type("STATE");
  command.option("session", options->session, "Session folder").required();
  command.option("-o,--output", options->outputs.model, "Model to write (.glb)")
      .required()
      .check(fault_of_model_name)
      .type("MODEL.glb");
  command
      .option("--state", options->outputs.state,
              "Write the new state here and leave the given one as it is")
      .type("FILE");
  command
      .option("--hold-out", options->frames.hold_out,
              "Keep every N-th frame out of the fit; 0: none")
      .not_negative()
      .show_default();
  add_frame_options(command, options->frames);
  add_common_options(command, context);
  command.action([options, &context] { run_resume(*options, context); });
}

}  // namespace sheen::app
