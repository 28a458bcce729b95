// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "evaluation/views/view_evaluation.h"
#include "pipeline/frame_statistics.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace sheen::evaluation {

/// One of the directions that an object is walked round in: eight of its sides (elevation below 30
/// degrees), eight obliquely from above (30 to 60) and one from the top. What faces down by more
/// than 30 degrees stands on something and is counted apart.
struct CoverageSector {
  std::size_t patches = 0;   ///< whose normals point there
  std::size_t observed = 0;  ///< of those, seen by at least one fitted frame
  std::size_t frames = 0;    ///< posed frames whose camera stood there
  std::size_t held_out_views = 0;
  double held_out_psnr_db = 0;  ///< mean over these views
};

/// Azimuths are counter-clockwise about the board's z from its x axis, elevations above its plane.
struct Coverage {
  static constexpr int kAzimuths = 8;
  static constexpr int kSectors = 2 * kAzimuths + 1;
  std::array<CoverageSector, kSectors> sectors;
  CoverageSector underneath;
};

/// Which sector a direction in board coordinates (any length but zero) belongs to; nothing for one
/// that points down by more than 30 degrees.
std::optional<int> sector_of(const Eigen::Vector3d& direction);

/// "45 to 90 degrees, obliquely from above", for people.
std::string sector_text(int sector);

/// Where the object was seen from and how well. `observed` has an entry per vertex of `mesh`;
/// `held_out` may be null.
Coverage measure_coverage(const core::Mesh& mesh, const Eigen::Isometry3d& board_from_object,
                          std::span<const std::uint8_t> observed,
                          const pipeline::FrameStatistics& frames,
                          const EvaluationSummary* held_out);

/// {"sectors": [{"where", "patches", "observed", "frames", "held_out_views", "held_out_psnr"}],
/// "underneath": {"patches", "observed"}}; docs/batch.md. PSNR is null without views.
nlohmann::ordered_json to_json(const Coverage& coverage);

}  // namespace sheen::evaluation
