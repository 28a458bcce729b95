// SPDX-License-Identifier: MIT
#pragma once

#include "capture/calibration/camera_file.h"
#include "capture/pose/board.h"
#include "capture/session/session_recorder.h"
#include "tests/capture/rendered_board.h"
#include "tests/support/temporary_folder.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace sheen::capture::test {

inline constexpr ImageSize kRecordedSize{64, 48};

/// A camera's image, told from others by its brightness (index modulo 40), with padding up to
/// `bytes`, different for each.
inline std::vector<std::uint8_t> recorded_jpeg(int index, std::size_t bytes = 0) {
  std::vector<std::uint8_t> jpeg;
  const cv::Mat image(kRecordedSize.height_px, kRecordedSize.width_px, CV_8UC3,
                      cv::Scalar::all(20 + 5 * (index % 40)));
  cv::imencode(".jpg", image, jpeg, {cv::IMWRITE_JPEG_QUALITY, 95});
  if (jpeg.size() % 2 == static_cast<std::size_t>(index % 2)) jpeg.push_back(0);  // odd and even
  if (jpeg.size() < bytes) jpeg.resize(bytes - bytes % 2 + static_cast<std::size_t>(index % 2), 0);
  return jpeg;
}

inline int recorded_index(const cv::Mat& image) {
  return static_cast<int>(std::lround((cv::mean(image)[0] - 20) / 5));
}

/// Image `index` at 30 a second.
inline LiveImage live_image(int index, std::size_t bytes = 0) {
  return {std::make_shared<const std::vector<std::uint8_t>>(recorded_jpeg(index, bytes)),
          std::llround(index / 30.0 * 1e6), static_cast<std::uint32_t>(index + 5)};
}

/// What a recording needs besides images.
inline SessionSetup recording_setup(const tests::TemporaryFolder& scratch) {
  write_board(scratch.path() / "the_board.yaml", make_grid_board("tag36h11", 2, 2, 0.04, 0.05));
  scratch.write("the_mesh.ply", "ply\n");
  return {make_camera(kRecordedSize.width_px, kRecordedSize.height_px, false),
          scratch.path() / "the_board.yaml", scratch.path() / "the_mesh.ply",
          Eigen::Isometry3d(Eigen::Translation3d(0.5, 0, 0))};
}

}  // namespace sheen::capture::test
