// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/sample_batch.h"
#include "evaluation/study/material.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sheen::evaluation {

/// One view of a point as the fitters get it.
struct TrainingSample {
  std::uint32_t frame_idx;  ///< position of the view in time; ascending within a point
  Eigen::Vector2f uv;       ///< on the unit disc
  Eigen::Vector3f rgb;      ///< display value
};

/// What should be seen from a direction: no noise, in [0, 1].
struct TestSample {
  Eigen::Vector2f uv;
  Eigen::Vector3f rgb;
  bool held_out_sector;  ///< in the sector that no training view covers (ViewSet::gap)
};

/// A patch of the study.
struct StudyPoint {
  MaterialClass material;
  std::vector<TrainingSample> training;
  std::vector<TestSample> test;
};

/// Points with their views: patch i is point i.
struct StudySet {
  std::string name;
  std::size_t frame_count = 0;
  std::vector<StudyPoint> points;

  /// Samples of all points, frame by frame: frame k holds at most one sample of each point.
  [[nodiscard]] std::vector<core::SampleBatch> batches() const;
  [[nodiscard]] std::size_t sample_count() const;
};

/// The points of one class as a set of their own.
StudySet only(const StudySet& set, MaterialClass material);

}  // namespace sheen::evaluation
