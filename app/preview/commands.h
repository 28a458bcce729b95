// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/view_state.h"
#include "app/preview/window.h"

#include <optional>
#include <span>

namespace sheen::app {

/// What a person can ask of the window.
enum class ViewCommand {
  show_radiance,
  show_needs_views,
  show_misfit,
  show_mesh,
  swap_views,
  toggle_overlay,
  toggle_path,
  frame_object,
  pause,
  undo,
  save,
  snapshot,
  help,
  quit
};

/// A key, what it does, and the words for both.
struct KeyBinding {
  int key;
  int modifiers;
  ViewCommand command;
  const char* key_text;
  const char* meaning;
  bool live_only;  ///< without meaning for a finished model
};

/// All of them, in the order in which the help shows them.
std::span<const KeyBinding> key_bindings();

std::optional<ViewCommand> command_of(const KeyPress& press);

/// Obeys a command that shows, hides or swaps parts of the views; false for all others.
bool turns(ViewState& state, ViewCommand command);

}  // namespace sheen::app
