// SPDX-License-Identifier: MIT
#pragma once

#include "core/image/metrics.h"
#include "render/renderer.h"

#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>

#include <optional>
#include <vector>

namespace sheen::evaluation {

/// How one rendered view compares with its image.
struct ViewError {
  int index = 0;
  core::ImageError error;
  std::size_t covered_pixels = 0;  ///< of error.pixels, drawn from patches seen in the fit
};

/// Figures over all views of an evaluation (docs/conventions.md, "image error").
struct EvaluationSummary {
  core::ImageError mean;    ///< means over views; pixels is the sum
  core::ImageError median;  ///< medians over views
  double covered_fraction = 0;
  std::vector<ViewError> views;
};

/// Pixels that count: those of `mask`, where the object's mesh is seen from the view's pose, eroded
/// by two against silhouette and pose error. What the model leaves uncovered of them counts as
/// black. Nothing when no pixel is left.
std::optional<ViewError> compare_view(int index, const render::RenderedView& rendered,
                                      const cv::Mat& photograph, const cv::Mat& mask);

EvaluationSummary summarise(std::vector<ViewError> views);

/// {"psnr", "ssim", "rmse"}
nlohmann::ordered_json to_json(const core::ImageError& error);
/// {"mean", "median", "covered_fraction", "views"}
nlohmann::ordered_json to_json(const EvaluationSummary& summary);

}  // namespace sheen::evaluation
