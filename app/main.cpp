// SPDX-License-Identifier: MIT
#include "app/commands/bake.h"
#include "app/commands/batch.h"
#include "app/commands/board.h"
#include "app/commands/calibrate.h"
#include "app/commands/capture.h"
#include "app/commands/compare.h"
#include "app/commands/evaluate.h"
#include "app/commands/export_command.h"
#include "app/commands/forget.h"
#include "app/commands/import.h"
#include "app/commands/info.h"
#include "app/commands/merge.h"
#include "app/commands/mesh.h"
#include "app/commands/register.h"
#include "app/commands/render.h"
#include "app/commands/replay.h"
#include "app/commands/resume.h"
#include "app/commands/survey.h"
#include "app/commands/synth.h"
#include "app/commands/view.h"
#include "app/interrupt.h"
#include "app/start/run_start.h"
#include "core/diagnostics/error.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>

namespace {

constexpr int kDone = 0;
constexpr int kRunFailed = 1;
constexpr int kBadInput = 2;
constexpr int kInterrupted = 130;  // 128 + SIGINT, as shells expect

constexpr const char* kThreeCommands =
    "From an object to its light field in three commands:\n"
    "  sheen board                          print sheen-board.pdf at 100 %, put the object on it\n"
    "  sheen replay walk.mp4 -o model.glb   after filming a walk round it: camera and mesh are\n"
    "                                       found from the film\n"
    "  sheen view model.glb                 look at it\n"
    "All commands: sheen --help\n";

}  // namespace

int main(int argc, char** argv) {
  using namespace sheen;
  app::CommandLine program(
      "Sheen captures how an object looks from every direction: a recording of a walk round it\n"
      "becomes a surface light field that can be drawn from anywhere.",
      "sheen " SHEEN_VERSION,
      "Film a walk round an object on a printed sheet:\n"
      "  sheen board                          the sheet, to be printed at 100 %\n"
      "  sheen replay walk.mp4 -o model.glb   camera, mesh and light field from the film\n"
      "  sheen view model.glb                 look at it\n"
      "Or start with the recording that comes with the source:\n"
      "  sheen replay sample_data/glossy -o model.glb --hold-out 5\n"
      "  sheen evaluate model.glb sample_data/glossy/held_out\n"
      "Without arguments, on a display: a window that does all of this.\n"
      "Exit codes: 0 done, 1 failed while running, 2 bad arguments or bad input.");
  app::CommandContext context;
  app::add_board_command(program, context);
  app::add_capture_command(program, context);
  app::add_calibrate_command(program, context);
  app::add_survey_command(program, context);
  app::add_mesh_command(program, context);
  app::add_register_command(program, context);
  app::add_import_command(program, context);
  app::add_replay_command(program, context);
  app::add_resume_command(program, context);
  app::add_merge_command(program, context);
  app::add_forget_command(program, context);
  app::add_render_command(program, context);
  app::add_evaluate_command(program, context);
  app::add_export_command(program, context);
  app::add_bake_command(program, context);
  app::add_compare_command(program, context);
  app::add_batch_command(program, context);
  app::add_synth_command(program, context);
  app::add_info_command(program, context);
  app::add_view_command(program, context);

  app::watch_for_interrupts();
  try {
    if (argc == 1) {
      if (!app::run_start(".")) std::fputs(kThreeCommands, stdout);
      return kDone;
    }
    program.run(argc, argv);
    return kDone;
  } catch (const core::Error& error) {
    std::fprintf(stderr, "sheen: %s\n", error.what());
    return error.kind() == core::Error::Kind::bad_input ? kBadInput : kRunFailed;
  } catch (const app::Interrupted& interruption) {
    std::fprintf(stderr, "sheen: %s\n", interruption.what());
    return kInterrupted;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "sheen: %s\n", error.what());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    std::fputs("sheen: memory is used up; close other programs or take a smaller mesh\n", stderr);
    return kRunFailed;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sheen: %s\n", error.what());
    return kRunFailed;
  }
}
