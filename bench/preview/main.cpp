// SPDX-License-Identifier: MIT
// How often the window is redrawn while a recording comes in at a camera's pace: one line of CSV
// each for a view that is turned without pause, one that rests, and one turned after the recording
// has ended. Needs a display.
#include "app/preview/live_session.h"
#include "app/preview/preview_window.h"
#include "bench/preview/camera_pace.h"
#include "capture/session/session.h"
#include "core/diagnostics/cpu_clock.h"
#include "pipeline/reconstruct.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>

namespace sheen::bench {
namespace {

constexpr double kTurn_px = 3;  // a redraw, of a drag over the view
constexpr double kAfter_s = 4;  // of turning after the end

struct PaceOptions {
  std::string session;
  double fps = 30;
  int threads = 2;
};

/// The pipeline of `sheen replay --preview` over a recording that comes in at a camera's pace.
class Capture {
 public:
  Capture(const PaceOptions& options, const capture::Session& session)
      : pace_(options.fps),
        fitted_({.session = session,
                 .frames = std::make_unique<PacedSource>(capture::open_frames(session), pace_)},
                {.undoable = true, .threads = options.threads}, sink_),
        live_({.model = fitted_.model(),
               .history = fitted_.history(),
               .baseline = nullptr,
               .mesh = fitted_.mesh(),
               .camera = session.camera,
               .board_from_object = session.board_from_object,
               .limits = {},
               .is_camera = true,
               .save = {}}) {}

  app::LiveSession& live() { return live_; }
  [[nodiscard]] bool is_done() const { return is_done_; }
  [[nodiscard]] int dropped() const { return pace_.dropped(); }

  void run() {
    fitted_.run(sink_, &live_);
    live_.finish();
    is_done_ = true;
  }

 private:
  CameraPace pace_;
  pipeline::ProgressSink sink_;
  pipeline::Reconstruction fitted_;
  app::LiveSession live_;
  std::atomic<bool> is_done_{false};
};

/// Redraws as long as `goes_on` says and prints how often.
template <typename GoesOn>
void measure(const char* what, app::PreviewWindow& window, const Capture& capture, bool turns,
             const GoesOn& goes_on) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const double begin_ms = core::process_cpu_ms();
  int redraws = 0;
  while (goes_on(std::chrono::duration<double>(Clock::now() - begin).count())) {
    if (turns) window.camera().orbit({kTurn_px, 0}, 720);
    window.redraw(turns ? 0 : 0.1);
    ++redraws;
  }
  const double wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  fmt::print("{},{:.1f},{:.2f},{}\n", what, redraws / wall_s,
             1e-3 * (core::process_cpu_ms() - begin_ms) / wall_s, capture.dropped());
  std::fflush(stdout);
}

void run(const PaceOptions& options) {
  const capture::Session session = capture::open_session(options.session);
  fmt::print("view,redraws_per_s,cores,frames_dropped\n");
  for (const bool turns : {true, false}) {
    Capture capture(options, session);
    app::PreviewWindow window({.title = "Sheen",
                               .mesh = capture.live().mesh(),
                               .up = capture.live().up(),
                               .live = &capture.live()});
    window.redraw(0);
    std::jthread pipeline([&] { capture.run(); });
    measure(turns ? "turning" : "resting", window, capture, turns,
            [&](double) { return !capture.is_done(); });
    if (turns) {
      measure("turning after the end", window, capture, true,
              [&](double seconds) { return seconds < kAfter_s; });
    }
    capture.live().close();
  }
}

}  // namespace
}  // namespace sheen::bench

int main(int argc, char** argv) {
  sheen::bench::PaceOptions options;
  CLI::App program("Redraws a second of the window while a recording comes in at a camera's pace");
  program.add_option("session", options.session, "Session folder")->required();
  program.add_option("--fps", options.fps, "Frames a second")->capture_default_str();
  program.add_option("--threads", options.threads, "Threads of the pipeline")
      ->capture_default_str();
  CLI11_PARSE(program, argc, argv);
  try {
    sheen::bench::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
