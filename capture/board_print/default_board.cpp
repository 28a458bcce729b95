// SPDX-License-Identifier: MIT
#include "capture/board_print/default_board.h"

#include "capture/pose/board_diagnosis.h"
#include "core/diagnostics/error.h"

#include <algorithm>

namespace sheen::capture {
namespace {

BoardDesign design_of(const DefaultSheet& sheet) {
  BoardDesign design;
  design.paper = *std::find_if(kPapers.begin(), kPapers.end(),
                               [&](const Paper& paper) { return paper.name == sheet.paper; });
  return design;
}

}  // namespace

std::optional<DefaultSheet> default_sheet_of(const BoardDesign& design) {
  const BoardDesign plain;
  if (design.family != plain.family || design.tag_mm != plain.tag_mm || design.columns ||
      design.rows || design.full_grid) {
    return std::nullopt;
  }
  for (const DefaultSheet& sheet : kDefaultSheets) {
    if (sheet.paper == design.paper.name) return sheet;
  }
  return std::nullopt;
}

Board default_board(const DefaultSheet& sheet) {
  return plan_board(design_of(sheet)).board;
}

Board all_default_tags() {
  Board all = default_board(kDefaultSheets.front());
  for (const DefaultSheet& sheet : kDefaultSheets) all.tags.merge(default_board(sheet).tags);
  return all;
}

std::optional<DefaultSheet> recognise_default_sheet(const std::vector<TagDetection>& tags) {
  std::optional<DefaultSheet> best;
  std::ptrdiff_t most = 0;
  for (const DefaultSheet& sheet : kDefaultSheets) {
    const Board board = default_board(sheet);
    const auto count = std::count_if(tags.begin(), tags.end(), [&](const TagDetection& tag) {
      return board.tags.contains(tag.id);
    });
    if (count > most) best = sheet;
    most = std::max(most, count);
  }
  return best;
}

void refuse_other_board(const std::filesystem::path& session, const core::CameraModel& camera,
                        const Frame& frame) {
  BoardDiagnosis diagnosis(all_default_tags(), camera);
  diagnosis.look_at(frame);
  const PoseCause cause = diagnosis.cause(PoseRejection::no_tags);
  if (cause.suspect != PoseSuspect::board) return;
  throw core::bad_input(
      session,
      "its first image shows another board than the sheet of sheen board, which " + cause.fault,
      "give the file of that board: --board board.yaml");
}

}  // namespace sheen::capture
