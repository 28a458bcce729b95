// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/report/progress.h"
#include "evaluation/report/table.h"
#include "evaluation/stress/stress_recording.h"

#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace sheen::evaluation {

/// Candidates (comparison/candidates.h) that every damaged session is fitted with: the default, its
/// patches without a texture, the paper's quadtree, harmonics and what all of them should beat.
inline constexpr std::array kStressCandidates{"detail", "sparse", "paper-quadtree", "sh3", "mean"};

/// A pose that puts the object's vertices farther off than this, RMS in the image, is wrong.
inline constexpr double kWrongPose_px = 2;

/// What becomes of a session with one kind of damage of one severity.
struct StressRow {
  std::string kind;
  std::string unit;
  double severity = 0;
  int frames = 0;
  int posed = 0;
  int refused = 0;
  int rightly_refused = 0;    ///< would have had no pose or a wrong one without the gate
  int wrongly_posed = 0;      ///< posed, and wrong by more than kWrongPose_px
  double pose_error_mm = 0;   ///< RMS motion of the vertices, median over posed frames
  double pose_error_deg = 0;  ///< rotation, median over posed frames
  /// Held-out PSNR of kStressCandidates; empty where the whole session was refused.
  std::vector<double> psnr_db;
  std::vector<std::string> notes;  ///< those that the undamaged session does not get
  std::string refusal;             ///< the error's line where the session was refused
};

/// Runs the undamaged session and every severity of the kinds named in `only` (all when empty).
/// Sessions are written inside `folder`, one at a time, and removed. Throws std::invalid_argument
/// for an unknown kind.
std::vector<StressRow> run_stress(const StressOptions& options,
                                  const std::vector<std::string>& only,
                                  const std::filesystem::path& folder, const Progress& progress);

/// What the program says of a damage: "refused", "noted", "frames refused" (more than a fifth),
/// else "nothing".
std::string what_was_said(const StressRow& row);

/// One row per session.
Table stress_table(std::span<const StressRow> rows);

/// Per kind: the first severity at which each candidate falls below the undamaged session's mean
/// colours, and severities that cost the default more than 1 dB without a word.
Table stress_limits(std::span<const StressRow> rows);

nlohmann::ordered_json to_json(std::span<const StressRow> rows);

}  // namespace sheen::evaluation
