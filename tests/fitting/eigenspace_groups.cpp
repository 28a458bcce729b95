// SPDX-License-Identifier: MIT
// Compiled twice: PACKED_BYTES is the function's name.
#include "tests/fitting/eigenspace_groups.h"

#include "fitting/multi_eigenspace/pack_pictures.h"
#include "fitting/multi_eigenspace/partition_views.h"

#include <opencv2/core.hpp>

#include <cmath>
#include <numbers>

namespace sheen::fitting::testing {
namespace {

using namespace multi_eigenspace;

constexpr int kViews = 48, kSide_px = 40;

/// Stripes that move as the heading does; a disc is covered.
std::vector<cv::Mat> turning_pictures() {
  std::vector<cv::Mat> pictures;
  for (int view = 0; view < kViews; ++view) {
    const double angle = 2 * std::numbers::pi * view / kViews;
    cv::Mat& picture = pictures.emplace_back(kSide_px, kSide_px, CV_8UC4);
    for (int y = 0; y < kSide_px; ++y) {
      for (int x = 0; x < kSide_px; ++x) {
        const double across = x - kSide_px / 2.0, down = y - kSide_px / 2.0;
        const auto stripe = [&](double pitch_px, double shift) {
          return cv::saturate_cast<std::uint8_t>(
              128 + 100 * std::sin(across / pitch_px + 6 * std::sin(angle + shift)) *
                        std::cos(down / pitch_px));
        };
        picture.at<cv::Vec4b>(y, x) = {
            stripe(3, 0), stripe(5, 1), stripe(4, 2),
            static_cast<std::uint8_t>(across * across + down * down < 300 ? 255 : 0)};
      }
    }
  }
  return pictures;
}

template <typename Value>
void append(const Value* values, std::size_t count, std::vector<std::uint8_t>& bytes) {
  const auto* const first = reinterpret_cast<const std::uint8_t*>(values);
  bytes.insert(bytes.end(), first, first + count * sizeof(Value));
}

}  // namespace

__attribute__((visibility("default"))) std::vector<std::uint8_t> PACKED_BYTES() {
  const std::vector<cv::Mat> pictures = turning_pictures();
  std::vector<Eigen::Vector3d> directions;
  for (int view = 0; view < kViews; ++view) {
    const double angle = 2 * std::numbers::pi * view / kViews;
    directions.emplace_back(0.8 * std::cos(angle), 0.8 * std::sin(angle), 0.6);
  }
  const cv::Mat weights = pixel_weights(pictures);
  const Partition partition =
      partition_views(gram_of(pictures, weights), ViewGraph(directions), {3, 10}, 1);
  std::vector<std::uint8_t> bytes;
  append(partition.owners.data(), partition.owners.size(), bytes);
  for (std::uint32_t g = 0; g < partition.groups.size(); ++g) {
    const PackedSpace packed =
        pack_pictures(pictures, weights, partition.groups[g].members, {}, g, {3, 100});
    append(packed.space.mean.ptr(), packed.space.mean.total() * 4, bytes);
    for (const cv::Mat& image : packed.space.images) append(image.ptr(), image.total() * 4, bytes);
    for (const ViewInSpace& view : packed.views) {
      append(view.coefficients.data(), view.coefficients.size(), bytes);
    }
  }
  return bytes;
}

}  // namespace sheen::fitting::testing
