// SPDX-License-Identifier: MIT
// In place of board_pdf.cpp where the build leaves it out (SHEEN_BOARD_PDF off).
#include "capture/board_print/board_pdf.h"

#include "core/diagnostics/error.h"

namespace sheen::capture {

void write_board_pdf(const std::filesystem::path& path, const BoardPlan& /*plan*/) {
  throw core::Error(core::Error::Kind::run_failed, path,
                    "cannot be made, this build of sheen draws no PDF",
                    "build with SHEEN_BOARD_PDF=ON");
}

}  // namespace sheen::capture
