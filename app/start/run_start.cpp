// SPDX-License-Identifier: MIT
#include "app/start/run_start.h"

#include "app/interrupt.h"
#include "app/start/start_window.h"
#include "core/diagnostics/error.h"

namespace sheen::app {
namespace {

constexpr double kLongestWait_s = 0.1;  // cameras and commands tell nothing by themselves

}  // namespace

bool run_start(const std::filesystem::path& snapshot_folder) {
  try {
    Window::check_display();
  } catch (const core::Error&) {
    return false;
  }
  StartWindow window(cameras_of_this_machine(), snapshot_folder);
  while (window.redraw(kLongestWait_s)) throw_if_interrupted();
  return true;
}

}  // namespace sheen::app
