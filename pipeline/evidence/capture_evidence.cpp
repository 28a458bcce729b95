// SPDX-License-Identifier: MIT
#include "pipeline/evidence/capture_evidence.h"

#include "core/mesh/bounds.h"
#include "core/numerics/median.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostGrains = 16, kGrainSpacing = 4;
constexpr int kLeastGrainStep_px = 3, kGrainPixels = 6000;
// Chosen on bench/stress with seed 1 and the recordings named in docs/stability-sessions.md.
constexpr double kGrainy = 10;  // grey levels, above which outlines and colours tell nothing sure
constexpr double kWidestGap_deg = 120;
constexpr int kFewFrames = 12;

void append(std::vector<Finding> more, std::vector<Finding>& findings) {
  for (Finding& finding : more) findings.push_back(std::move(finding));
}

}  // namespace

CaptureEvidence::CaptureEvidence(const capture::Session& session, const core::Mesh& mesh,
                                 std::size_t patch_count,
                                 const std::optional<capture::Board>& board)
    : board_from_object_(session.board_from_object),
      middle_(core::bounds_of(mesh).center().cast<double>()),
      outline_(mesh),
      light_(patch_count),
      depth_(session.depth ? session.depth->unit_m : 1),
      grains_(kMostGrains, kGrainSpacing) {
  if (board) {
    corners_.emplace(*board, session.camera);
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
  depth_.look_at(observation);
  light_.look_at(frame.index, observation.samples, observation.view);
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

/// Corners do not fit, the object is not where poses and mesh put it, or nowhere in the images.
bool CaptureEvidence::are_poses_doubtful(const std::vector<Finding>& corners,
                                         const std::vector<Finding>& misplaced) const {
  return !corners.empty() || !misplaced.empty() || !outline_.misplacement();
}

std::optional<capture::IdFault> CaptureEvidence::board_fault() const {
  if (!tags_ || !are_poses_doubtful(corners_->findings(), outline_.findings())) return std::nullopt;
  return tags_->fault();
}

std::vector<Finding> CaptureEvidence::faults() const {
  const std::vector<Finding> corners = corners_ ? corners_->findings() : std::vector<Finding>{};
  const std::vector<Finding> misplaced = outline_.findings();
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
  const LightEvidence::Verdict light = light_.verdict();
  append(LightEvidence::drifts(light), faults);
  if (!corners.empty() || noise > kGrainy) return faults;

  // Outlines and colours are off, too, where poses are: the cause has been named.
  append(misplaced.empty() ? LightEvidence::contradictions(light) : misplaced, faults);
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
