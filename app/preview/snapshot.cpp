// SPDX-License-Identifier: MIT
#include "app/preview/snapshot.h"

#include "core/diagnostics/error.h"
#include "core/image/write_image.h"

#include <fmt/format.h>

namespace sheen::app {

std::string save_snapshot(const cv::Mat& image, const std::filesystem::path& folder) {
  int number = 1;
  const auto name = [&] { return fmt::format("sheen-{:03}.png", number); };
  std::error_code no_throw;
  while (std::filesystem::exists(folder / name(), no_throw)) ++number;
  try {
    core::write_image(folder / name(), image);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "Snapshot " + name();
}

}  // namespace sheen::app
