// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board_refinement.h"
#include "core/diagnostics/stage_timer.h"
#include "evaluation/coverage/coverage_sectors.h"
#include "evaluation/views/view_evaluation.h"
#include "fitting/fitter.h"
#include "pipeline/evidence/finding.h"
#include "pipeline/frame_statistics.h"
#include "pipeline/mesh_heights.h"
#include "pipeline/mesh_placement.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace sheen::app {

/// Everything a replay has to say at its end.
struct ReplayReport {
  const pipeline::FrameStatistics& frames;
  const core::StageTimer& timer;
  fitting::FitStatistics fit;
  bool is_levelled = false;  ///< frames were brought to one exposure by the paper of the board
  double readout_s = 0;      ///< of the camera: told or measured (Intrinsics::readout_s)
  double finish_ms = 0;      ///< CPU time of what the fit put off to the end
  std::string representation;
  std::size_t patches = 0;
  std::size_t patches_observed = 0;
  std::size_t coefficients = 0;
  std::size_t model_bytes = 0;
  std::optional<capture::BoardRefinement> board;          ///< where the tags were refined
  std::optional<pipeline::MeshPlacement> placement;       ///< where the mesh was put right
  std::optional<pipeline::MeshRefinement> mesh;           ///< where it was to be refined
  std::optional<evaluation::EvaluationSummary> held_out;  ///< of the fitted representation
  std::optional<evaluation::EvaluationSummary>
      held_out_mean;  ///< of the mean colours, on the same views
  /// Of the fitted representation, with the held-out poses refined against it too.
  std::optional<evaluation::EvaluationSummary> held_out_refined_poses;
  std::vector<pipeline::Finding> findings;  ///< what the data show to be wrong with the recording
  /// From where the object was seen; where the model has patches.
  std::optional<evaluation::Coverage> coverage;
  nlohmann::ordered_json options;
};

/// The report as JSON; `held_out_mean_colour` holds the baseline's held-out figures.
nlohmann::ordered_json to_json(const ReplayReport& report);

/// The same for people: a short table.
std::string to_text(const ReplayReport& report);

}  // namespace sheen::app
