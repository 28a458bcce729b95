// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <vector>

extern "C" {
#include <libavcodec/codec_id.h>
#include <libavutil/pixfmt.h>
}

namespace sheen::capture::test {

/// A video made by FFmpeg's libraries: flat images, one colour in the left half and one in the
/// right, with whatever facts a container can state about them.
struct VideoSpec {
  AVCodecID codec = AV_CODEC_ID_FFV1;
  AVPixelFormat format = AV_PIX_FMT_YUV444P;
  int width = 64, height = 48;

  // How colours are coded: by the formulas of the standards, not by libswscale.
  AVColorSpace matrix = AVCOL_SPC_BT709;
  bool is_full_range = false;
  AVColorTransferCharacteristic transfer = AVCOL_TRC_BT709;
  AVColorPrimaries primaries = AVCOL_PRI_BT709;
  bool states_colours = true;

  std::vector<std::int64_t>
      stamps_ms;                       ///< of every frame; negative ones are hidden by an edit list
  std::optional<double> pixel_aspect;  ///< width of a pixel over its height
  std::optional<double> clockwise_degrees;  ///< a display matrix
  std::set<int> damaged;                    ///< frames with zeros in their data

  /// Coded colour (R'G'B' in [0, 1]) of a frame's left and right half.
  std::function<Eigen::Vector3d(int frame, bool is_right)> colour;
};

/// The ending of `path` chooses the container.
void write_video(const std::filesystem::path& path, const VideoSpec& spec);

}  // namespace sheen::capture::test
