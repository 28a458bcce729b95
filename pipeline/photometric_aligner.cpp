// SPDX-License-Identifier: MIT
#include "pipeline/photometric_aligner.h"

#include "core/alignment/seamless_neighbours.h"

#include <algorithm>
#include <cmath>

namespace sheen::pipeline {
namespace {

constexpr std::uint16_t kMinSamples = 3;  // a patch seen less often says more about its own errors
constexpr double kSmoothingPx = 1.0;
constexpr int kRegionMarginPx = 8;

Eigen::Vector3f colour_of(const fitting::PatchLightField& model, std::size_t patch_idx, float u,
                          float v) {
  const auto weighted = model.evaluate(patch_idx, {u, v});
  return weighted.colour_sum / weighted.weight_sum;
}

float luma_of(const Eigen::Vector3f& rgb) {
  return core::luma(rgb.x(), rgb.y(), rgb.z());
}

}  // namespace

PhotometricAligner::PhotometricAligner(const core::Mesh& mesh, double pose_error_px)
    : mesh_(mesh),
      pose_error_px_(pose_error_px),
      neighbours_(core::seamless_neighbours(mesh)),
      seen_(mesh.positions.size(), 0),
      is_usable_(mesh.positions.size(), 0) {}

void PhotometricAligner::note_integrated(const core::SampleBatch& batch) {
  for (const std::uint32_t patch_idx : batch.patch) {
    if (seen_[patch_idx] < kMinSamples) ++seen_[patch_idx];
    is_usable_[patch_idx] = seen_[patch_idx] >= kMinSamples;
  }
}

std::optional<core::Alignment> PhotometricAligner::align(
    const cv::Mat& image, const core::VertexView& view, const fitting::PatchLightField& model,
    const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object) {
  const auto region = core::visible_region(view, kRegionMarginPx);
  if (!region) return std::nullopt;
  image_.look_at(image, *region, kSmoothingPx);
  core::select_points(view, neighbours_, is_usable_, image_, {}, selected_);
  expect(view, model);
  core::AlignmentLimits limits;
  limits.prior_px = pose_error_px_;
  return core::align_pose(points_, image_, camera, camera_from_object, limits);
}

std::optional<double> PhotometricAligner::gain(const core::SampleBatch& batch,
                                               const fitting::PatchLightField& model) {
  measured_.clear();
  predicted_.clear();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (is_usable_[batch.patch[i]] == 0) continue;
    measured_.push_back(core::luma(batch.r[i], batch.g[i], batch.b[i]));
    predicted_.push_back(luma_of(colour_of(model, batch.patch[i], batch.u[i], batch.v[i])));
  }
  return core::estimate_gain(measured_, predicted_, {}, ratios_);
}

void PhotometricAligner::expect(const core::VertexView& view,
                                const fitting::PatchLightField& model) {
  points_.clear();
  for (const std::uint32_t i : selected_) {
    const float luma = luma_of(colour_of(model, i, view.u[i], view.v[i]));
    if (!std::isfinite(luma)) continue;
    points_.position.push_back(mesh_.positions[i]);
    points_.luma.push_back(std::clamp(luma, 0.0f, 1.0f));
    points_.weight.push_back(1.0f);
  }
}

void divide_by_gain(double gain, core::SampleBatch& batch) {
  const auto factor = static_cast<float>(1 / gain);
  for (auto* column : {&batch.r, &batch.g, &batch.b}) {
    for (float& value : *column) value = std::min(value * factor, 1.0f);
  }
}

}  // namespace sheen::pipeline
