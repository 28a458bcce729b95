// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"
#include "fitting/model_file/model_file.h"
#include "pipeline/options.h"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace sheen::app {

/// What a conversion costs: pictures of a model beside those of what a reader of the converted file
/// sees.
struct ConversionCost {
  /// Between the two, from all sides of the object, over the pixels that show it: PSNR of 8-bit
  /// sRGB.
  double difference_db = 0;
  /// Against the images of a session, where one is given: means over its views, dB.
  struct OnViews {
    std::size_t views = 0;
    double model_db = 0, converted_db = 0;
  };
  std::optional<OnViews> on_views;
};

/// `session` may be empty. Throws core::Error.
ConversionCost conversion_cost(const fitting::Model& model, const fitting::Model& converted,
                               const std::filesystem::path& session,
                               const pipeline::FrameChoice& frames, const CommandContext& context);

nlohmann::ordered_json to_json(const ConversionCost& cost);
std::string to_text(const ConversionCost& cost);

}  // namespace sheen::app
