// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"
#include "pipeline/session_dataset.h"

#include <filesystem>
#include <string>

namespace sheen::app {

/// What `sheen export SESSION` is asked.
struct DatasetExport {
  std::string format;  ///< name in capture/dataset/dataset_formats.h; empty: not said
  bool undistort = false;
};

/// Names of the formats that are written, with their sentences where the help wants them.
std::vector<std::string> written_dataset_formats();
std::string dataset_formats_help();

/// Writes a session as a data set for other programs. Throws core::Error (bad_input) for a folder
/// that exists already.
void export_dataset(const std::filesystem::path& session, const std::filesystem::path& folder,
                    const DatasetExport& options, const pipeline::FrameChoice& frames,
                    const CommandContext& context);

}  // namespace sheen::app
