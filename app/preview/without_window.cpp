// SPDX-License-Identifier: MIT
// In place of the window where the build leaves it out (SHEEN_WINDOW off).
#include "app/preview/run_preview.h"
#include "app/start/run_start.h"
#include "core/diagnostics/error.h"

namespace sheen::app {
namespace {

core::Error no_window() {
  return {core::Error::Kind::run_failed, "this build of sheen", "opens no windows",
          "leave out --preview, capture with --headless, or build with SHEEN_WINDOW=ON"};
}

}  // namespace

void check_display() {
  throw no_window();
}

void run_viewer(const PreviewSubject& /*subject*/) {
  throw no_window();
}

void run_preview(const PreviewSubject& /*subject*/, const std::function<void()>& /*work*/,
                 const std::function<void()>& /*on_closed*/) {
  throw no_window();
}

void run_walk(const WalkSubject& /*subject*/, const std::function<void()>& /*work*/,
              const std::function<void()>& /*on_closed*/) {
  throw no_window();
}

bool run_start(const std::filesystem::path& /*snapshot_folder*/) {
  return false;
}

}  // namespace sheen::app
