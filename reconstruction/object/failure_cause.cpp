// SPDX-License-Identifier: MIT
#include "reconstruction/object/failure_cause.h"

#include "reconstruction/object/coarse_pass.h"
#include "reconstruction/object/outline_pass.h"
#include "reconstruction/object/refusals.h"

#include <algorithm>

namespace sheen::reconstruction {
namespace {

constexpr double kCauseTexels = 2e5;
constexpr int kCauseCells = 48;

/// What stands on a part of the sheet by a first pass over some of the views.
Components standing_on(const Eigen::AlignedBox2f& region, const capture::Board& board,
                       const ViewSet& views, int threads) {
  const CoarseGrids grids{plane_grid(views, stage_region(board), kCauseTexels), region,
                          kCauseCells};
  CoarseHull found =
      carve_coarsely(board, views, grids, 0, nullptr, threads, [](std::string_view, int, int) {});
  return standing_in(found.grid);
}

ViewSet part_of(const ViewSet& views, std::size_t begin, std::size_t end) {
  ViewSet part{views.camera, views.rays, {}};
  part.views.assign(views.views.begin() + static_cast<std::ptrdiff_t>(begin),
                    views.views.begin() + static_cast<std::ptrdiff_t>(end));
  return part;
}

}  // namespace

void refuse_by_cause(const std::filesystem::path& session, const capture::Board& board,
                     const ViewSet& views, float paper_share, int threads) {
  refuse_paper_like(session, paper_share);
  const Components all = standing_on(stage_region(board), board, views, threads);
  if (!all.parts.empty()) refuse_beside_tags(session, board, all.parts[0]);
  const std::size_t half = views.views.size() / 2;
  const Eigen::AlignedBox2f region = object_region(board);
  const Components first = standing_on(region, board, part_of(views, 0, half), threads);
  const Components second =
      standing_on(region, board, part_of(views, half, views.views.size()), threads);
  if (!first.parts.empty() && !second.parts.empty()) {
    refuse_two_places(session, first.parts[0], second.parts[0]);
  }
}

}  // namespace sheen::reconstruction
