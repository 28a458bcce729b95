// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/observation.h"
#include "pipeline/evidence/finding.h"
#include "pipeline/thinned.h"

#include <optional>

namespace sheen::pipeline {

/// How far away depth images have the object, against mesh and pose: another unit is off by the
/// same factor everywhere.
class DepthEvidence {
 public:
  /// `unit_m` as session.json has it.
  explicit DepthEvidence(double unit_m);

  /// An observation without depth is passed over.
  void look_at(const core::Observation& observation);

  [[nodiscard]] std::optional<Finding> finding() const;

 private:
  double unit_m_;
  Thinned<double> ratios_;  ///< depth over the mesh's, the median of a frame
};

}  // namespace sheen::pipeline
