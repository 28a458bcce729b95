// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

#include <opencv2/core.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace sheen::app {

/// Pictures of a model from all round.
struct TurntableOptions {
  int pictures = 0;  ///< of one turn; 0: none is asked for
  cv::Size size_px{800, 800};
  std::optional<cv::Scalar> background{};  ///< B, G, R; nothing: transparent, in a video dark grey
  std::string up = "z";                    ///< axis of the object (exporters/upright.h)
  int copies = 1;                          ///< in one picture, each turned otherwise
  int fps = 30;                            ///< of a video
};

/// "640x480"; throws UsageError for others, and for sides beyond 16 to 8192.
cv::Size picture_size(const std::string& text);
/// none, dark, light or #rrggbb; throws UsageError for others.
std::optional<cv::Scalar> background_colour(const std::string& text);

/// Draws one turn of the object: NNNN.png in the folder `output`, or the video `output` when it
/// ends in .mp4. Outlines are smooth. More than one copy only of eigenspaces; throws UsageError for
/// others.
void render_turntable(const std::filesystem::path& model, const std::filesystem::path& output,
                      const TurntableOptions& options, const CommandContext& context);

}  // namespace sheen::app
