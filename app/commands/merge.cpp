// SPDX-License-Identifier: MIT
#include "app/commands/merge.h"

#include "app/state/joined_model.h"

#include <memory>

namespace sheen::app {
namespace {

struct MergeOptions {
  std::vector<std::filesystem::path> states;
  JoinedOutputs outputs;
};

void run_merge(const MergeOptions& options, const CommandContext& context) {
  context.check_outputs({options.outputs.model, options.outputs.state});
  States states;
  for (const auto& path : options.states) {
    states.push_back(std::make_unique<fitting::StateReader>(path));
  }
  write_joined_model(states, fitting::join(states), options.outputs, context);
}

}  // namespace

void add_merge_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<MergeOptions>();
  Command command =
      program.command("merge", "Join fit states into the model that all their views give");
  command.example(
      "Walks on several days, two cameras at once, parts of a long one: the result is that of one\n"
      "fit to all views, to the last bit, whatever the order of the states.\n"
      "Example:\n"
      "  sheen replay monday -o monday.glb --state monday.state\n"
      "  sheen replay friday -o friday.glb --state friday.state\n"
      "  sheen merge monday.state friday.state -o both.glb");
  command.option("states", options->states, "What replay --state wrote")
      .required()
      .type("STATE...");
  command.option("-o,--output", options->outputs.model, "Model to write (.glb)")
      .required()
      .check(fault_of_model_name)
      .type("MODEL.glb");
  command.option("--state", options->outputs.state, "Also write the joined state").type("FILE");
  add_common_options(command, context);
  command.action([options, &context] { run_merge(*options, context); });
}

}  // namespace sheen::app
