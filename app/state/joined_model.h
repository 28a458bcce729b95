// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"
#include "fitting/state/join_states.h"

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace sheen::app {

using States = std::vector<std::unique_ptr<fitting::StateReader>>;

/// Where the fit of states goes; empty: not written.
struct JoinedOutputs {
  std::filesystem::path model;
  std::filesystem::path state;
};

/// Fits views of states, writes the model, then the state, and tells what it holds.
void write_joined_model(const States& states, std::span<const fitting::JoinedView> views,
                        const JoinedOutputs& outputs, const CommandContext& context);

/// An option's check: models are .glb.
std::string fault_of_model_name(const std::string& path);

}  // namespace sheen::app
