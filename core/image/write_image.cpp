// SPDX-License-Identifier: MIT
#include "core/image/write_image.h"

#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"

#include <opencv2/imgcodecs.hpp>

namespace sheen::core {

void write_image(const std::filesystem::path& path, const cv::Mat& image) {
  if (!cv::haveImageWriter(path.string())) {
    throw bad_input(path, "has an ending no image format is known for", "name it .png or .jpg");
  }
  StagedOutput output(path);
  if (!cv::imwrite(output.path().string(), image)) {
    throw Error(Error::Kind::run_failed, path, "could not be written",
                "check free space and permissions");
  }
  output.commit();
}

}  // namespace sheen::core
