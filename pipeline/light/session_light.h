// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/paper_light.h"
#include "capture/session/session.h"
#include "pipeline/options.h"
#include "pipeline/progress_sink.h"

#include <optional>

namespace sheen::pipeline {

/// What reads the paper of the session's board. Nothing where it has none, or one that cannot be
/// read: whoever needs it for poses says so.
std::optional<capture::PaperReader> paper_reader(const capture::Session& session);

/// Looks at twelve frames spread over the recording. Where their exposure or white balance clearly
/// changes, puts the usual light of the paper into the session, which makes frames be brought to it
/// (LightLeveller), and notes it. Needs a board, wherever the poses come from.
void complete_light(capture::Session& session, const FrameChoice& choice, ProgressSink& sink);

}  // namespace sheen::pipeline
