// SPDX-License-Identifier: MIT
#include "app/preview/commands.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>

namespace sheen::app {
namespace {

constexpr std::array kBindings{
    KeyBinding{GLFW_KEY_1, 0, ViewCommand::show_radiance, "1", "Radiance", false},
    KeyBinding{GLFW_KEY_2, 0, ViewCommand::show_needs_views, "2", "Where views are missing", true},
    KeyBinding{GLFW_KEY_3, 0, ViewCommand::show_misfit, "3", "Where the model does not fit", true},
    KeyBinding{GLFW_KEY_4, 0, ViewCommand::show_mesh, "4", "Mesh", false},
    KeyBinding{GLFW_KEY_TAB, 0, ViewCommand::swap_views, "Tab", "Swap camera and model", true},
    KeyBinding{GLFW_KEY_O, 0, ViewCommand::toggle_overlay, "O", "Object over the image", true},
    KeyBinding{GLFW_KEY_P, 0, ViewCommand::toggle_path, "P", "Path of the camera", true},
    KeyBinding{GLFW_KEY_F, 0, ViewCommand::frame_object, "F", "Frame the object", false},
    KeyBinding{GLFW_KEY_SPACE, 0, ViewCommand::pause, "Space", "Pause and go on", true},
    KeyBinding{GLFW_KEY_Z, GLFW_MOD_CONTROL, ViewCommand::undo, "Ctrl+Z", "Undo the last 5 seconds",
               true},
    KeyBinding{GLFW_KEY_S, GLFW_MOD_CONTROL, ViewCommand::save, "Ctrl+S", "Save the model now",
               true},
    KeyBinding{GLFW_KEY_F12, 0, ViewCommand::snapshot, "F12", "Snapshot of the window", false},
    KeyBinding{GLFW_KEY_H, 0, ViewCommand::help, "H", "This help", false},
    KeyBinding{GLFW_KEY_ESCAPE, 0, ViewCommand::quit, "Esc, Q", "Close", false},
    KeyBinding{GLFW_KEY_Q, 0, ViewCommand::quit, nullptr, nullptr, false}};

}  // namespace

std::span<const KeyBinding> key_bindings() {
  return kBindings;
}

std::optional<ViewCommand> command_of(const KeyPress& press) {
  // Locks and the like do not matter.
  const int modifiers = press.modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER);
  for (const KeyBinding& binding : kBindings) {
    if (binding.key == press.key && binding.modifiers == modifiers) return binding.command;
  }
  return std::nullopt;
}

bool turns(ViewState& state, ViewCommand command) {
  switch (command) {
    case ViewCommand::swap_views:
      state.camera_is_large = !state.camera_is_large;
      return true;
    case ViewCommand::toggle_overlay:
      state.overlay = !state.overlay;
      return true;
    case ViewCommand::toggle_path:
      state.path = !state.path;
      return true;
    default:
      return false;
  }
}

}  // namespace sheen::app
