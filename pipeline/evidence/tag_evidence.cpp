// SPDX-License-Identifier: MIT
#include "pipeline/evidence/tag_evidence.h"

#include "capture/pose/board_tags.h"
#include "core/diagnostics/error.h"

#include <fmt/format.h>

#include <string>

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostTagViews = 6, kTagSpacing = 4;
constexpr int kFewestSightings = 2;  // of one tag: noise does not decode to it twice
constexpr std::size_t kFewestUnknown = 3;

/// "3, 4, 5, ..."
std::string list_of(const std::vector<int>& ids) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < ids.size() && i < most; ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(ids[i]);
  }
  return ids.size() > most ? text + ", ..." : text;
}

}  // namespace

TagEvidence::TagEvidence(const capture::Board& board, const core::CameraModel& camera)
    : board_(board), camera_(camera), greys_(kMostTagViews, kTagSpacing) {}

void TagEvidence::look_at(const capture::Frame& frame) {
  if (greys_.is_due()) greys_.add(capture::grey_of(frame).clone());
}

std::vector<std::vector<capture::TagDetection>> TagEvidence::tags() const {
  // Codes as printed, no bit corrected: in doubt a tag is not there.
  const capture::TagDetector detector(
      capture::find_tag_family(board_.family, board_.border_bits).value(), 0);
  std::vector<std::vector<capture::TagDetection>> views;
  for (const cv::Mat& grey : greys_.items()) {
    views.push_back(capture::drop_ambiguous(detector.detect(grey)));
  }
  return views;
}

std::optional<capture::IdFault> TagEvidence::fault() const {
  return capture::shifted_ids(board_, camera_, tags());
}

void TagEvidence::refuse_shifted(const std::filesystem::path& board) const {
  if (const auto found = fault()) throw core::bad_input(board, found->fault, found->remedy);
}

std::vector<Finding> TagEvidence::findings(bool is_elsewhere) const {
  const auto views = tags();
  if (const auto fault = capture::shifted_ids(board_, camera_, views)) {
    return {{"tag-ids", "board.yaml: " + fault->fault + "; " + fault->remedy}};
  }
  const capture::TagPlaces places = capture::place_tags(board_, camera_, views);
  std::vector<Finding> findings;
  std::vector<int> moved, unknown;
  for (const auto& [id, seen] : places.of_tag) {
    if (seen.elsewhere >= kFewestSightings && seen.in_place == 0) moved.push_back(id);
  }
  for (const auto& [id, count] : places.unknown) {
    if (count >= kFewestSightings) unknown.push_back(id);
  }
  if (!moved.empty()) {
    findings.push_back(
        {"tag-places",
         fmt::format("tags {} do not lie where board.yaml says; are ids exchanged, or is another "
                     "board in view? Give the board.yaml of the print that the object stands on",
                     list_of(moved))});
  }
  const bool is_minority = places.seen - places.known > places.known;
  if (unknown.size() >= kFewestUnknown && (is_minority || is_elsewhere)) {
    findings.push_back(
        {"unknown-tags",
         fmt::format("{} tags of the board's family are in view that board.yaml does not hold (ids "
                     "{}), beside {} that it does; does the object stand on another board? Give "
                     "that one's board.yaml",
                     unknown.size(), list_of(unknown), places.of_tag.size())});
  }
  return findings;
}

}  // namespace sheen::pipeline
