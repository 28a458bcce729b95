// SPDX-License-Identifier: MIT
#include "pipeline/evidence/capture_evidence.h"

#include "core/mesh/bounds.h"
#include "core/numerics/median.h"
#include "pipeline/light/recording_light.h"
#include "pipeline/light/session_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostGrains = 16, kGrainSpacing = 4;
constexpr std::size_t kMostPapers = 32, kPaperSpacing = 4;
constexpr int kLeastGrainStep_px = 3, kGrainPixels = 6000;
// Chosen on bench/stress with seed 1 and the recordings named in docs/stability-sessions.md.
constexpr double kGrainy = 10;  // grey levels, above which outlines and colours tell nothing sure
constexpr double kWidestGap_deg = 120;
constexpr int kFewFrames = 12;

void append(std::vector<Finding> more, std::vector<Finding>& findings) {
  for (Finding& finding : more) findings.push_back(std::move(finding));
}

/// Corners of the object's bounding box.
std::vector<Eigen::Vector3d> box_in_board(const capture::Session& session, const core::Mesh& mesh) {
  const Eigen::AlignedBox3d box = core::bounds_of(mesh).cast<double>();
  std::vector<Eigen::Vector3d> corners;
  for (int corner = 0; corner < 8; ++corner) {
    corners.push_back(session.board_from_object *
                      box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  return corners;
}

}  // namespace

CaptureEvidence::CaptureEvidence(const capture::Session& session, const core::Mesh& mesh,
                                 const core::Mesh& patches,
                                 const std::optional<capture::Board>& board)
    : board_from_object_(session.board_from_object),
      middle_(core::bounds_of(mesh).center().cast<double>()),
      outline_(mesh),
      print_(patches),
      light_(patches.positions.size()),
      depth_(session.depth ? session.depth->unit_m : 1),
      is_levelled_(!session.paper_light.empty()),
      paper_(paper_reader(session)),
      paper_lights_(kMostPapers, kPaperSpacing),
      grains_(kMostGrains, kGrainSpacing) {
  if (board) {
    corners_.emplace(*board, session.camera, box_in_board(session, mesh));
    tags_.emplace(*board, session.camera);
  }
}

void CaptureEvidence::look_at(const capture::Frame& frame,
                              const Eigen::Isometry3d& camera_from_board,
                              const core::Observation& observation) {
  if (corners_) {
    corners_->look_at(frame, camera_from_board,
                      last_index_ + 1 == frame.index ? last_pose_ : std::nullopt);
  }
  if (tags_) tags_->look_at(frame);
  outline_.look_at(frame.index, frame.image, observation.camera, observation.camera_from_object);
  print_.look_at(frame.index, frame.image, observation.view, observation.camera,
                 observation.camera_from_object);
  depth_.look_at(observation);
  light_.look_at(frame.index, observation.samples, observation.view);
  if (paper_ && paper_lights_.is_due()) {
    paper_lights_.add(paper_->read(frame.image, camera_from_board));
  }
  if (grains_.is_due()) measure_grain(frame.image);
  const Eigen::Vector3d eye = observation.camera_from_object.inverse().translation() - middle_;
  const Eigen::Vector3d on_board = board_from_object_.linear() * eye;
  azimuths_rad_.push_back(static_cast<float>(std::atan2(on_board.y(), on_board.x())));
  last_pose_ = camera_from_board;
  last_index_ = frame.index;
}

/// J. Immerkaer, Fast noise variance estimation, 1996, in green and with a median, which edges do
/// not move: the difference of two Laplacians takes out whatever is linear.
void CaptureEvidence::measure_grain(const cv::Mat& image) {
  constexpr double whole = 6;  // square root of the sum of the mask's squares
  const int step_px =
      std::max(kLeastGrainStep_px,
               static_cast<int>(std::sqrt(static_cast<double>(image.total()) / kGrainPixels)));
  std::vector<double> sizes;
  for (int y = 1; y + 1 < image.rows; y += step_px) {
    for (int x = 1; x + 1 < image.cols; x += step_px) {
      const auto green = [&](int row, int column) {
        return static_cast<int>(image.at<cv::Vec3b>(y + row, x + column)[1]);
      };
      const int middle = green(0, 0);
      if (middle < 20 || middle > 235) continue;  // cut off on one side
      const int corners = green(-1, -1) + green(-1, 1) + green(1, -1) + green(1, 1);
      const int sides = green(-1, 0) + green(1, 0) + green(0, -1) + green(0, 1);
      sizes.push_back(std::abs(corners - 2 * sides + 4 * middle) / whole);
    }
  }
  grains_.add(sizes.empty() ? 0 : 1.4826 * core::upper_median(sizes));
}

double CaptureEvidence::grain() const {
  auto grains = grains_.items();
  return grains.empty() ? 0 : core::upper_median(grains);
}

/// Of exposure and white balance; where paper is seen that knows better than the object.
std::vector<Finding> CaptureEvidence::drifts(const LightEvidence::Verdict& verdict) const {
  const auto paper = solve_light(paper_lights_.items());
  if (!paper) return LightEvidence::drifts(verdict);
  if (is_levelled_ || !clearly_changes(*paper)) return {};
  return {{"exposure-drift", describe(paper->change) +
                                 ", by the paper around the tags: lock both in the camera; sheen "
                                 "replay of the session levels them"}};
}

std::vector<Finding> CaptureEvidence::misplaced() const {
  std::vector<Finding> findings;
  if (misplaced_) findings.push_back(*misplaced_);
  append(outline_.findings(), findings);
  return findings;
}

/// Corners do not fit, the object is not where poses and mesh put it, or nowhere in the images.
bool CaptureEvidence::are_poses_doubtful(const std::vector<Finding>& corners,
                                         const std::vector<Finding>& misplaced) const {
  return !corners.empty() || !misplaced.empty() || !outline_.misplacement();
}

std::optional<capture::IdFault> CaptureEvidence::board_fault() const {
  if (!tags_ || !are_poses_doubtful(corners_->findings(), misplaced())) return std::nullopt;
  return tags_->fault();
}

std::vector<Finding> CaptureEvidence::faults() const {
  const std::vector<Finding> corners = corners_ ? corners_->findings() : std::vector<Finding>{};
  const std::vector<Finding> misplaced = this->misplaced();
  std::vector<Finding> faults;
  if (tags_ && are_poses_doubtful(corners, misplaced)) {
    append(tags_->findings(!misplaced.empty()), faults);
    if (!faults.empty() && faults.front().cause == "tag-ids") return faults;
  }
  const double noise = grain();
  if (noise > kGrainy) {
    faults.push_back({"noise", fmt::format("the images are grainy: noise of {:.0f} of 255 levels; "
                                           "more light, or longer exposure and slower motion",
                                           noise)});
  }
  if (auto unit = depth_.finding()) faults.push_back(std::move(*unit));
  append(corners, faults);
  const std::vector<Finding> weak = corners_ ? corners_->weaknesses() : std::vector<Finding>{};
  append(weak, faults);
  const LightEvidence::Verdict light = light_.verdict();
  append(drifts(light), faults);
  if (!corners.empty() || noise > kGrainy) return faults;

  // Outlines and colours are off, too, where poses are: the cause has been named.
  std::vector<Finding> elsewhere = misplaced;
  if (elsewhere.empty() && weak.empty()) elsewhere = print_.findings();
  append(elsewhere.empty() ? LightEvidence::contradictions(light) : std::move(elsewhere), faults);
  return faults;
}

std::optional<Finding> CaptureEvidence::coverage() const {
  if (frames() < kFewFrames) {
    return Finding{"few-frames",
                   fmt::format("only {} frames were fitted: what lies between their directions is "
                               "guessed; record more, all round the object",
                               frames())};
  }
  std::vector<float> azimuths = azimuths_rad_;
  std::ranges::sort(azimuths);
  constexpr double turn = 2 * std::numbers::pi;
  double gap = static_cast<double>(azimuths.front() - azimuths.back()) + turn;
  for (std::size_t i = 1; i < azimuths.size(); ++i) {
    gap = std::max(gap, static_cast<double>(azimuths[i] - azimuths[i - 1]));
  }
  const double gap_deg = 360 * gap / turn;
  if (gap_deg <= kWidestGap_deg) return std::nullopt;
  return Finding{
      "one-side",
      fmt::format("the object was seen from one side: no frame from {:.0f} of the 360 degrees "
                  "round it, and from there the model is a guess; record that side, too",
                  gap_deg)};
}

std::vector<Finding> CaptureEvidence::findings() const {
  std::vector<Finding> findings = faults();
  if (auto finding = coverage()) findings.push_back(std::move(*finding));
  return findings;
}

}  // namespace sheen::pipeline
