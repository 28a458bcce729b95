// SPDX-License-Identifier: MIT
#include "evaluation/views/view_evaluation.h"

#include <opencv2/core.hpp>

#include <algorithm>

namespace sheen::evaluation {
namespace {

constexpr int kErosionPx = 2;

template <typename Field>
double mean_of(const std::vector<ViewError>& views, Field field) {
  double sum = 0;
  for (const ViewError& view : views) sum += view.error.*field;
  return sum / static_cast<double>(views.size());
}

template <typename Field>
double median_of(const std::vector<ViewError>& views, Field field) {
  std::vector<double> values;
  values.reserve(views.size());
  for (const ViewError& view : views) values.push_back(view.error.*field);
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace

std::optional<ViewError> compare_view(int index, const render::RenderedView& rendered,
                                      const cv::Mat& photograph, const cv::Mat& mask) {
  const cv::Mat counted = core::eroded(mask, kErosionPx);
  const auto error = core::image_error(rendered.image, photograph, counted);
  if (!error) return std::nullopt;
  const cv::Mat covered = counted & rendered.support;
  return ViewError{index, *error, static_cast<std::size_t>(cv::countNonZero(covered))};
}

EvaluationSummary summarise(std::vector<ViewError> views) {
  EvaluationSummary summary;
  if (!views.empty()) {
    std::size_t covered = 0;
    for (const ViewError& view : views) {
      summary.mean.pixels += view.error.pixels;
      covered += view.covered_pixels;
    }
    using core::ImageError;
    summary.mean.psnr_db = mean_of(views, &ImageError::psnr_db);
    summary.mean.ssim = mean_of(views, &ImageError::ssim);
    summary.mean.rmse = mean_of(views, &ImageError::rmse);
    summary.median.psnr_db = median_of(views, &ImageError::psnr_db);
    summary.median.ssim = median_of(views, &ImageError::ssim);
    summary.median.rmse = median_of(views, &ImageError::rmse);
    summary.covered_fraction =
        static_cast<double>(covered) / static_cast<double>(summary.mean.pixels);
  }
  summary.views = std::move(views);
  return summary;
}

nlohmann::ordered_json to_json(const core::ImageError& error) {
  return {{"psnr", error.psnr_db}, {"ssim", error.ssim}, {"rmse", error.rmse}};
}

nlohmann::ordered_json to_json(const EvaluationSummary& summary) {
  nlohmann::ordered_json views = nlohmann::ordered_json::array();
  for (const ViewError& view : summary.views) {
    nlohmann::ordered_json entry{{"index", view.index}};
    entry.update(to_json(view.error));
    entry["pixels"] = view.error.pixels;
    views.push_back(std::move(entry));
  }
  return {{"mean", to_json(summary.mean)},
          {"median", to_json(summary.median)},
          {"covered_fraction", summary.covered_fraction},
          {"views", std::move(views)}};
}

}  // namespace sheen::evaluation
