// SPDX-License-Identifier: MIT
#include "app/commands/camera_list.h"

#include "capture/source/v4l2_listing.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace sheen::app {
namespace {

nlohmann::ordered_json to_json(const capture::CameraListing& camera) {
  auto modes = nlohmann::ordered_json::array();
  for (const capture::CameraMode& mode : camera.modes) {
    modes.push_back({{"format", capture::format_name(mode.format)},
                     {"width", mode.size.width_px},
                     {"height", mode.size.height_px},
                     {"fps", mode.fps}});
  }
  auto controls = nlohmann::ordered_json::array();
  for (const capture::CameraControl& control : camera.controls) {
    controls.push_back({{"name", control.name},
                        {"minimum", control.minimum},
                        {"maximum", control.maximum},
                        {"step", control.step},
                        {"default", control.initial},
                        {"value", control.value}});
  }
  return {{"device", camera.device.string()},
          {"name", camera.name},
          {"bus", camera.bus},
          {"fault", camera.fault},
          {"modes", std::move(modes)},
          {"controls", std::move(controls)}};
}

/// Modes of one format and size on one line.
std::string modes_text(const std::vector<capture::CameraMode>& modes) {
  std::string text;
  const capture::CameraMode* last = nullptr;
  for (const capture::CameraMode& mode : modes) {
    const bool continues =
        last != nullptr && last->format == mode.format && last->size == mode.size;
    if (continues) {
      text += fmt::format(", {:g}", mode.fps);
    } else {
      text += fmt::format("{}  {} {}x{}  fps {:g}", last == nullptr ? "" : "\n",
                          capture::format_name(mode.format), mode.size.width_px,
                          mode.size.height_px, mode.fps);
    }
    last = &mode;
  }
  return last == nullptr ? text : text + "\n";
}

std::string to_text(const capture::CameraListing& camera) {
  std::string text = fmt::format("{}  {}  ({})\n", camera.device.string(), camera.name, camera.bus);
  if (!camera.fault.empty()) return text + "  " + camera.fault + "\n";
  text += modes_text(camera.modes);
  for (const capture::CameraControl& control : camera.controls) {
    text += fmt::format("  {} = {}  ({} to {}, default {})\n", control.name, control.value,
                        control.minimum, control.maximum, control.initial);
  }
  return text;
}

}  // namespace

void list_cameras(const CommandContext& context) {
  auto document = nlohmann::ordered_json::array();
  std::string text;
  for (const auto& camera : capture::list_cameras(capture::kernel_v4l2_system())) {
    document.push_back(to_json(camera));
    text += to_text(camera);
  }
  if (text.empty()) text = "no camera found: plug one in, or check who may read /dev/video*\n";
  context.publish({{"cameras", std::move(document)}}, text);
}

}  // namespace sheen::app
