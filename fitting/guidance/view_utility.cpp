// SPDX-License-Identifier: MIT
#include "fitting/guidance/view_utility.h"

#include "core/numerics/median.h"
#include "fitting/samples/sample.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace sheen::fitting::guidance {
namespace {

constexpr float kNoiseFloor = 0.01f * 0.01f;  // errors that a camera's noise explains, squared
constexpr std::uint16_t kMemory = 24;         // predictions after which old ones begin to fade
constexpr float kTrustAfter = 3;              // predictions that outweigh the typical patch

/// Mean of few observations, drawn towards what is typical.
float drawn(float mean, std::uint16_t count, float typical) {
  const auto n = static_cast<float>(count);
  return std::max((n * mean + kTrustAfter * typical) / (n + kTrustAfter), kNoiseFloor);
}

}  // namespace

ViewUtility::Prediction ViewUtility::predict(const core::SampleBatch& batch, std::size_t i,
                                             const PatchLightField& model) const {
  Prediction prediction;
  const PatchKnowledge& patch = patches_[batch.patch[i]];
  if (patch.samples == 0 || !usable_sample(batch, i)) return prediction;
  const Eigen::Vector2f uv(batch.u[i], batch.v[i]);
  const Eigen::Vector3f colour = model.evaluate(batch.patch[i], uv).colour();
  if (!colour.allFinite()) return prediction;
  prediction.measured = {batch.r[i], batch.g[i], batch.b[i]};
  prediction.predicted = colour.cwiseMax(0.0f).cwiseMin(1.0f);
  prediction.variance = predicted_variance(patch.seen, cell_of(uv));
  return prediction;
}

double ViewUtility::median_normalised_residual(const core::SampleBatch& batch, float gain) {
  scratch_.clear();
  for (std::size_t i = 0; i < predictions_.size(); ++i) {
    const Prediction& p = predictions_[i];
    if (p.variance != 0) continue;
    const float squared = (p.measured / gain - p.predicted).squaredNorm() / 3;
    scratch_.push_back(
        static_cast<double>(std::sqrt(squared / seen_direction_error(batch.patch[i]))));
  }
  return scratch_.empty() ? 0 : core::upper_median(scratch_);
}

// Of measured over predicted brightness; dark samples say nothing about it.
double ViewUtility::median_gain() {
  constexpr float dark = 0.1f;
  constexpr std::size_t few = 20;
  scratch_.clear();
  for (const Prediction& p : predictions_) {
    if (p.variance != 0 || p.predicted.mean() <= dark) continue;
    scratch_.push_back(static_cast<double>(p.measured.mean() / p.predicted.mean()));
  }
  return scratch_.size() < few ? 1 : std::max(core::upper_median(scratch_), 0.05);
}

FrameScore ViewUtility::score(const core::SampleBatch& batch, const PatchLightField& model) {
  FrameScore score;
  score.samples = batch.size();
  predictions_.resize(batch.size());
  double squared_error = 0;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const Prediction& prediction = predictions_[i] = predict(batch, i, model);
    if (prediction.variance < 0) continue;
    ++score.predicted;
    squared_error += static_cast<double>(prediction.squared_error());
    if (prediction.variance == 0) ++score.familiar;
  }
  if (score.predicted > 0) {
    score.squared_error = squared_error / static_cast<double>(score.predicted);
  }
  score.normalised_residual = median_normalised_residual(batch, 1);
  score.gain = median_gain();
  score.normalised_residual_without_gain =
      median_normalised_residual(batch, static_cast<float>(score.gain));
  return score;
}

// Moves a patch's mean towards a value, a plain mean at first, fading later; the total is plain.
void ViewUtility::learn(float& mean, std::uint16_t& count, float value, Totals& totals) {
  count = static_cast<std::uint16_t>(std::min<int>(count + 1, kMemory));
  mean += (value - mean) / static_cast<float>(count);
  totals.sum += static_cast<double>(value);
  ++totals.count;
}

void ViewUtility::note(const core::SampleBatch& batch) {
  assert(predictions_.size() == batch.size());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    PatchKnowledge& patch = patches_[batch.patch[i]];
    const Prediction& prediction = predictions_[i];
    if (prediction.variance == 0) {
      learn(patch.seen_direction_error, patch.seen_direction_count, prediction.squared_error(),
            seen_direction_);
    } else if (prediction.variance > 0) {
      learn(patch.unseen_direction_error, patch.unseen_direction_count,
            prediction.squared_error() / prediction.variance, unseen_direction_);
    }
    if (!usable_sample(batch, i)) continue;
    ++patch.samples;
    patch.seen |= cell_bit(cell_of({batch.u[i], batch.v[i]}));
  }
}

float ViewUtility::typical_unseen_direction_error() const {
  return unseen_direction_.count == 0
             ? kNoiseFloor
             : static_cast<float>(unseen_direction_.sum /
                                  static_cast<double>(unseen_direction_.count));
}

float ViewUtility::typical_seen_direction_error() const {
  return seen_direction_.count == 0
             ? kNoiseFloor
             : static_cast<float>(seen_direction_.sum / static_cast<double>(seen_direction_.count));
}

float ViewUtility::unseen_direction_error(std::size_t patch_idx) const {
  const PatchKnowledge& patch = patches_[patch_idx];
  return drawn(patch.unseen_direction_error, patch.unseen_direction_count,
               typical_unseen_direction_error());
}

float ViewUtility::seen_direction_error(std::size_t patch_idx) const {
  const PatchKnowledge& patch = patches_[patch_idx];
  return drawn(patch.seen_direction_error, patch.seen_direction_count,
               typical_seen_direction_error());
}

std::vector<float> smooth_unseen_direction_errors(const ViewUtility& utility,
                                                  const core::VertexNeighbours& neighbours) {
  constexpr int passes = 2;
  const std::size_t count = utility.patches().size();
  std::vector<float> errors(count);
  for (std::size_t i = 0; i < count; ++i) errors[i] = utility.unseen_direction_error(i);
  std::vector<float> before;
  for (int pass = 0; pass < passes; ++pass) {
    before = errors;
    for (std::size_t i = 0; i < count; ++i) {
      const auto around = neighbours.of(i);
      for (const std::uint32_t j : around) errors[i] += before[j];
      errors[i] /= static_cast<float>(1 + around.size());
    }
  }
  return errors;
}

float missing_variance(DirectionCells seen, DirectionCells reachable,
                       float unseen_direction_error) {
  return unseen_direction_error * variance_sum(seen, reachable) /
         static_cast<float>(std::max(1, std::popcount(reachable)));
}

double coverage(const std::vector<PatchKnowledge>& patches,
                const std::vector<DirectionCells>& reachable, const std::vector<float>& area) {
  double covered = 0;
  double total = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const int wanted = std::popcount(reachable[i]);
    if (wanted == 0) continue;
    const int close = std::popcount(dilated(patches[i].seen) & reachable[i]);
    total += static_cast<double>(area[i]);
    covered += static_cast<double>(area[i]) * close / wanted;
  }
  return total > 0 ? covered / total : 0;
}

std::vector<float> vertex_areas(const core::Mesh& mesh) {
  std::vector<float> area(mesh.positions.size(), 0.0f);
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3f& corner = mesh.positions[triangle[0]];
    const Eigen::Vector3f normal =
        (mesh.positions[triangle[1]] - corner).cross(mesh.positions[triangle[2]] - corner);
    for (int k = 0; k < 3; ++k) area[triangle[k]] += normal.norm() / 6;
  }
  return area;
}

}  // namespace sheen::fitting::guidance
