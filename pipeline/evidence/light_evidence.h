// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/sample_batch.h"
#include "core/samples/vertex_view.h"
#include "pipeline/evidence/finding.h"
#include "pipeline/thinned.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::pipeline {

/// Brightness of some hundred patches over the recording, against a model that is as simple as can
/// be: a patch has a colour that changes linearly with the direction it is seen from, a frame an
/// exposure per channel. Exposures that differ from frame to frame are drifts. A patch of one
/// colour in the image that fits nothing, and did not fit a frame before or after either, is
/// something before the object. Gloss is told by the white that it adds.
class LightEvidence {
 public:
  explicit LightEvidence(std::size_t patch_count);

  /// `view` says where in the image the patches of the samples are.
  void look_at(int frame_index, const core::SampleBatch& samples, const core::VertexView& view);

  /// All frames together; zeros where there are too few.
  struct Verdict {
    /// These three of the frames in which nearly every patch fits: range, without the extreme
    /// twentieths; the same; usual disagreement within a frame.
    double exposure_stops = 0;
    double balance_stops = 0;
    double disagreement_stops = 0;
    double odd_share = 0;            ///< of the usual frame
    std::vector<int> hidden_frames;  ///< where something hides part of the object
  };
  [[nodiscard]] Verdict verdict() const;

  static std::vector<Finding> drifts(const Verdict& verdict);
  /// What is worth saying only where poses and mesh are fine.
  static std::vector<Finding> contradictions(const Verdict& verdict);

  /// What the model says of each kept frame.
  struct FrameLight {
    int frame_index = 0;
    double exposure = 0;      ///< stops, as far as patches seen flatly and steeply agree
    double balance = 0;       ///< red against blue, stops, likewise
    double disagreement = 0;  ///< of those patches about the exposure, stops
    double odd_share = 0;     ///< of its samples that suddenly have another colour
    double blob_share = 0;    ///< of its samples that have, and that colour lies round them, too
  };
  [[nodiscard]] std::vector<FrameLight> frames() const;

 private:
  struct Sample {
    std::uint16_t slot;
    float u, v;
    float x_px, y_px;
    std::array<float, 3> stops;  ///< binary logarithm of linear light
  };
  struct FrameSamples {
    int frame_index = 0;
    std::vector<Sample> samples;
  };

  /// Where fitting starts: every patch has the median of its samples from everywhere.
  [[nodiscard]] std::vector<Eigen::Matrix3d> median_colours() const;

  std::size_t spacing_;  ///< of the patches that are kept
  std::size_t slots_;
  Thinned<FrameSamples> frames_;
};

}  // namespace sheen::pipeline
