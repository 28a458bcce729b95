// SPDX-License-Identifier: MIT
#include "pipeline/light/light_leveller.h"

#include "core/image/srgb_curve.h"
#include "pipeline/light/recording_light.h"
#include "pipeline/light/session_light.h"

#include <opencv2/core.hpp>

#include <cstdint>

namespace sheen::pipeline {
namespace {

/// Every code's, in light divided by `gain`; CV_8UC3, BGR, 1 x 256.
cv::Mat codes_divided_by(const Eigen::Vector3d& gain) {
  cv::Mat table(1, 256, CV_8UC3);
  for (int code = 0; code < 256; ++code) {
    const double light =
        static_cast<double>(core::linear_from_srgb(static_cast<float>(code) / 255));
    for (int channel = 0; channel < 3; ++channel) {
      const auto levelled = static_cast<float>(light / gain[2 - channel]);
      table.at<cv::Vec3b>(code)[channel] =
          cv::saturate_cast<std::uint8_t>(255 * core::srgb_from_linear(levelled));
    }
  }
  return table;
}

}  // namespace

LightLeveller::LightLeveller(const capture::Session& session) : usual_(session.paper_light) {
  if (!usual_.empty()) reader_ = paper_reader(session);
}

cv::Mat LightLeveller::level(const cv::Mat& image,
                             const Eigen::Isometry3d& camera_from_board) const {
  if (!reader_) return image;
  const auto gain = gain_of(reader_->read(image, camera_from_board), usual_);
  if (!gain) return image;
  cv::Mat levelled;
  cv::LUT(image, codes_divided_by(*gain), levelled);
  return levelled;
}

}  // namespace sheen::pipeline
