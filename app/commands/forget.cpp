// SPDX-License-Identifier: MIT
#include "app/commands/forget.h"

#include "app/state/joined_model.h"
#include "core/diagnostics/error.h"
#include "core/files/folder_lock.h"
#include "core/text/number.h"

#include <memory>
#include <optional>
#include <set>
#include <string>

namespace sheen::app {
namespace {

struct FrameRange {
  int first = 0;
  int last = 0;
};

struct ForgetOptions {
  std::filesystem::path state;
  std::optional<FrameRange> frames;
  std::string session;
  JoinedOutputs outputs;
};

/// "120-180" or "120".
FrameRange frame_range(const std::string& text) {
  const auto dash = text.find('-');
  const auto first = core::parse_whole_number(text.substr(0, dash));
  const auto last =
      dash == std::string::npos ? first : core::parse_whole_number(text.substr(dash + 1));
  constexpr long long most = 1'000'000'000;
  if (!first || !last || *first < 0 || *first > *last || *last > most) {
    throw UsageError("--frames is \"" + core::quotable(text) + "\", write 120-180 or 120");
  }
  return {static_cast<int>(*first), static_cast<int>(*last)};
}

/// Frame numbers mean something within a session only.
void check_is_clear(const ForgetOptions& options, const fitting::StateReader& state) {
  std::set<std::string> sessions;
  for (const fitting::StateView& view : state.views()) sessions.insert(view.session);
  if (options.session.empty() && sessions.size() > 1) {
    std::string names;
    for (const std::string& name : sessions) names += (names.empty() ? "" : ", ") + name;
    throw core::bad_input(options.state,
                          "holds several sessions (" + core::quotable(names, 200) + ")",
                          "name one by --session");
  }
  if (!options.session.empty() && !sessions.contains(options.session)) {
    throw core::bad_input(options.state,
                          "holds no session \"" + core::quotable(options.session) + "\"",
                          "see sheen info for what it holds");
  }
}

bool is_forgotten(const ForgetOptions& options, const fitting::StateView& view) {
  if (!options.session.empty() && view.session != options.session) return false;
  return !options.frames ||
         (options.frames->first <= view.frame && view.frame <= options.frames->last);
}

void run_forget(ForgetOptions options, const CommandContext& context) {
  if (options.outputs.state.empty()) options.outputs.state = options.state;
  context.check_outputs({options.outputs.model, options.outputs.state});
  // Of two that change one state the second would lose what the first has done.
  const auto lock = core::FolderLock::of_file(options.outputs.state);
  States states;
  states.push_back(std::make_unique<fitting::StateReader>(options.state));
  check_is_clear(options, *states.front());

  // Keep the others.
  std::vector<fitting::JoinedView> kept;
  const auto& views = states.front()->views();
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!is_forgotten(options, views[i])) kept.push_back({0, i});
  }
  if (kept.size() == views.size()) {
    throw core::bad_input(options.state, "holds none of these frames",
                          "see sheen info for what it holds");
  }
  if (kept.empty()) {
    throw core::bad_input(options.state, "would hold nothing", "delete it instead");
  }
  write_joined_model(states, kept, options.outputs, context);
}

}  // namespace

void add_forget_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<ForgetOptions>();
  Command command = program.command("forget", "Take frames out of a fit state, exactly");
  command.example(
      "Afterwards the state is one that never saw these frames.\n"
      "Example:\n"
      "  sheen forget vase.state --frames 120-180 -o vase.glb\n"
      "  sheen forget vase.state --session friday -o vase.glb");
  command.option("fit", options->state, "What replay --state wrote").required().type("STATE");
  const Option frames =
      command
          .option(
              "--frames",
              [options](const std::string& text) { options->frames = frame_range(text); },
              "These frames, the last one included")
          .type("A-B");
  const Option session = command
                             .option("--session", options->session,
                                     "Frames of this session only; without --frames all")
                             .type("NAME");
  command.after_parsing([frames, session] {
    if (!frames.is_given() && !session.is_given()) {
      throw UsageError("--frames or --session is required");
    }
  });
  command.option("-o,--output", options->outputs.model, "Also write the model of what stays (.glb)")
      .check(fault_of_model_name)
      .type("MODEL.glb");
  command
      .option("--state", options->outputs.state,
              "Write the new state here and leave the given one as it is")
      .type("FILE");
  add_common_options(command, context);
  command.action([options, &context] { run_forget(*options, context); });
}

}  // namespace sheen::app
