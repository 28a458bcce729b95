// SPDX-License-Identifier: MIT
#include "app/preview/snapshot.h"

#include "core/image/write_image.h"

#include <fmt/format.h>

namespace sheen::app {

std::filesystem::path write_snapshot(const cv::Mat& image, const std::filesystem::path& folder) {
  int number = 1;
  const auto name = [&] { return folder / fmt::format("sheen-{:03}.png", number); };
  while (std::filesystem::exists(name())) ++number;
  core::write_image(name(), image);
  return name();
}

}  // namespace sheen::app
