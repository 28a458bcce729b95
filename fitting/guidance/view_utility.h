// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/mesh/neighbours.h"
#include "core/samples/sample_batch.h"
#include "fitting/guidance/direction_cells.h"
#include "fitting/patch_light_field.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace sheen::fitting::guidance {

/// A frame's samples against what the model said of them before it took them in.
struct FrameScore {
  std::size_t samples = 0;
  std::size_t predicted = 0;  ///< of patches seen before
  std::size_t familiar = 0;   ///< of those, towards directions seen before
  double squared_error = 0;   ///< mean over the predicted ones and channels, sRGB
  /// Median size of the familiar ones' errors in units of what is usual for their patches.
  double normalised_residual = 0;
  /// Brightness of the frame against the model, over familiar samples.
  double gain = 1;
  /// Median normalised residual once the gain is taken out.
  double normalised_residual_without_gain = 0;
};

/// What is known about one patch, 24 bytes.
struct PatchKnowledge {
  DirectionCells seen = 0;
  std::uint32_t samples = 0;
  /// Mean squared error of predictions towards new directions, per predicted variance; and towards
  /// directions that had been seen. sRGB, mean of the channels.
  float unseen_direction_error = 0;
  float seen_direction_error = 0;
  std::uint16_t unseen_direction_count = 0;
  std::uint16_t seen_direction_count = 0;
};

/// Keeps score of how well views are predicted before they are integrated, and from where patches
/// have been seen. Two answers that are never mixed: where views are missing, and where the model
/// fails in directions that it has seen (too simple, or misregistered). Independent of the
/// representation; not thread-safe.
class ViewUtility {
 public:
  explicit ViewUtility(std::size_t patch_count) : patches_(patch_count) {}

  /// Compares a batch with the model, before it is integrated. Nothing is learnt yet.
  FrameScore score(const core::SampleBatch& batch, const PatchLightField& model);

  /// Learns from the batch that was scored last, which the model is about to integrate.
  void note(const core::SampleBatch& batch);

  [[nodiscard]] const std::vector<PatchKnowledge>& patches() const { return patches_; }

  /// Error variance to expect of a patch towards a direction that nobody has looked from, sRGB^2:
  /// what new directions have shown there, drawn towards `typical_unseen_direction_error` while
  /// they are few.
  [[nodiscard]] float unseen_direction_error(std::size_t patch_idx) const;
  /// The same towards directions seen before: noise, misregistration, too few terms.
  [[nodiscard]] float seen_direction_error(std::size_t patch_idx) const;
  /// Means over patches that have been predicted at all.
  [[nodiscard]] float typical_unseen_direction_error() const;
  [[nodiscard]] float typical_seen_direction_error() const;

 private:
  struct Totals {
    double sum = 0;
    std::size_t count = 0;
  };

  /// How a sample was predicted; meaningless where its patch had not been seen.
  struct Prediction {
    Eigen::Vector3f measured, predicted;
    float variance = -1;  ///< predicted, as a share of the patch's own; negative: no prediction
    [[nodiscard]] float squared_error() const { return (measured - predicted).squaredNorm() / 3; }
  };

  [[nodiscard]] Prediction predict(const core::SampleBatch& batch, std::size_t i,
                                   const PatchLightField& model) const;
  [[nodiscard]] double median_normalised_residual(const core::SampleBatch& batch, float gain);
  [[nodiscard]] double median_gain();
  static void learn(float& mean, std::uint16_t& count, float value, Totals& totals);

  std::vector<PatchKnowledge> patches_;
  Totals unseen_direction_, seen_direction_;
  std::vector<Prediction> predictions_;  ///< of the batch scored last
  std::vector<double> scratch_;
};

/// `unseen_direction_error` of every patch, averaged with its neighbours' and theirs: single
/// patches have seen too little to be told apart.
std::vector<float> smooth_unseen_direction_errors(const ViewUtility& utility,
                                                  const core::VertexNeighbours& neighbours);

/// Variance that missing views leave in a patch, as a mean over the directions `reachable`, sRGB^2:
/// predicted variance x `unseen_direction_error`. 0 where nothing is reachable.
float missing_variance(DirectionCells seen, DirectionCells reachable, float unseen_direction_error);

/// Share of the directions `reachable` that has been seen from close by, weighed by area: the
/// coverage of an object, [0, 1]. All three have an entry per patch; patches without reachable
/// directions do not count.
double coverage(const std::vector<PatchKnowledge>& patches,
                const std::vector<DirectionCells>& reachable, const std::vector<float>& area);

/// A third of the area of the triangles round every vertex, square metres.
std::vector<float> vertex_areas(const core::Mesh& mesh);

}  // namespace sheen::fitting::guidance
