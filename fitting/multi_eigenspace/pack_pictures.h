// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/multi_eigenspace/multi_eigenspace.h"
#include "fitting/multi_eigenspace/view_group.h"

#include <opencv2/core/mat.hpp>

#include <span>
#include <vector>

namespace sheen::fitting::multi_eigenspace {

/// How much each pixel of pictures counts: the mean part of them that the object covers, in 255ths,
/// rounded up. CV_8UC1. `pictures` (CV_8UC4) are not empty.
cv::Mat pixel_weights(std::span<const cv::Mat> pictures);

/// Inner products of pictures less their mean, over the sum of the weights and the four channels.
/// From sums of whole numbers, which are exact in any order: the same on every processor.
Gram gram_of(std::span<const cv::Mat> pictures, const cv::Mat& weights);

/// A space and what some views are in it.
struct PackedSpace {
  Eigenspace space;
  std::vector<ViewInSpace> views;
};

/// The eigenspace of `members`, as many images as `rule` wants, and the coefficients of these and
/// of `guards`.
struct PackRule {
  int most_eigenimages;
  double allowed;  ///< mean squared error of the members, grey levels^2
};
PackedSpace pack_pictures(std::span<const cv::Mat> pictures, const cv::Mat& weights,
                          const std::vector<std::uint32_t>& members,
                          const std::vector<std::uint32_t>& guards, std::uint32_t space_idx,
                          const PackRule& rule);

}  // namespace sheen::fitting::multi_eigenspace
