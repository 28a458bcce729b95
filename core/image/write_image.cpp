// SPDX-License-Identifier: MIT
#include "core/image/write_image.h"

#include "core/diagnostics/error.h"
#include "core/files/write_file.h"

#include <opencv2/imgcodecs.hpp>

#include <cstdint>
#include <string_view>
#include <vector>

namespace sheen::core {

void write_image(const std::filesystem::path& path, const cv::Mat& image) {
  if (!cv::haveImageWriter(path.string())) {
    throw bad_input(path, "has an ending no image format is known for", "name it .png or .jpg");
  }
  // In memory first: encoders that write files themselves tell a full disk on stderr, too.
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(path.extension().string(), image, bytes)) {
    throw Error(Error::Kind::run_failed, path, "could not be encoded", "name it .png or .jpg");
  }
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace sheen::core
