// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "fitting/state/state_file.h"
#include "pipeline/fit_stage.h"

#include <filesystem>
#include <optional>

namespace sheen::app {

/// The fit state of a session while it is replayed.
class SessionState {
 public:
  explicit SessionState(const capture::Session& session);

  /// Writes views once the state is open, and nothing before. Valid as long as this object.
  pipeline::SamplesListener listener();

  /// Throws core::Error (bad_input) when the place cannot be written or the representation takes
  /// images, which no state holds.
  void open(const std::filesystem::path& path, const fitting::StateHeader& header);

  /// Moves the file into place, where one was opened.
  void commit();

 private:
  fitting::StateView view_;
  std::optional<fitting::StateWriter> writer_;
};

}  // namespace sheen::app
