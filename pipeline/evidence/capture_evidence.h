// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/paper_light.h"
#include "capture/session/session.h"
#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
#include "pipeline/evidence/corner_evidence.h"
#include "pipeline/evidence/depth_evidence.h"
#include "pipeline/evidence/finding.h"
#include "pipeline/evidence/light_evidence.h"
#include "pipeline/evidence/outline_evidence.h"
#include "pipeline/evidence/print_evidence.h"
#include "pipeline/evidence/tag_evidence.h"
#include "pipeline/thinned.h"

#include <Eigen/Geometry>

#include <optional>
#include <utility>
#include <vector>

namespace sheen::pipeline {

/// What a recording's own data show to be wrong with it, by the trace that each fault leaves:
/// corners of tags, outlines, print, brightness, depths, grain, and from where the object was seen.
/// Looks at every fourth frame, and in long recordings at fewer. The result does not depend on what
/// is fitted.
class CaptureEvidence {
 public:
  /// `mesh` is the object's, `patches` the one whose vertices give the samples; both must outlive
  /// this. `board` is that of the tags that give the poses, if they do.
  CaptureEvidence(const capture::Session& session, const core::Mesh& mesh,
                  const core::Mesh& patches, const std::optional<capture::Board>& board);

  /// A posed frame that is fitted, and what it shows of the surface.
  void look_at(const capture::Frame& frame, const Eigen::Isometry3d& camera_from_board,
               const core::Observation& observation);

  /// What place_mesh has found about the mesh as it was given; told where outlines are.
  void note(Finding misplaced) { misplaced_ = std::move(misplaced); }

  /// What can be said so far of a recording that goes on.
  [[nodiscard]] std::vector<Finding> faults() const;

  /// Everything, after the last frame.
  [[nodiscard]] std::vector<Finding> findings() const;

  /// Poses from tags are wrong throughout, for which nothing helps but another board.yaml.
  [[nodiscard]] std::optional<capture::IdFault> board_fault() const;

  [[nodiscard]] int frames() const { return static_cast<int>(azimuths_rad_.size()); }

 private:
  void measure_grain(const cv::Mat& image);
  [[nodiscard]] double grain() const;
  [[nodiscard]] std::vector<Finding> drifts(const LightEvidence::Verdict& verdict) const;
  [[nodiscard]] std::optional<Finding> coverage() const;
  [[nodiscard]] std::vector<Finding> misplaced() const;
  [[nodiscard]] bool are_poses_doubtful(const std::vector<Finding>& corners,
                                        const std::vector<Finding>& misplaced) const;

  Eigen::Isometry3d board_from_object_;
  Eigen::Vector3d middle_;  ///< of the object, in its frame
  std::optional<CornerEvidence> corners_;
  std::optional<TagEvidence> tags_;
  OutlineEvidence outline_;
  std::optional<Finding> misplaced_;  ///< the mesh as it was given
  PrintEvidence print_;
  LightEvidence light_;
  DepthEvidence depth_;
  bool is_levelled_;  ///< by the paper, which has been noted
  std::optional<capture::PaperReader> paper_;
  Thinned<std::vector<capture::PaperLight>> paper_lights_;
  Thinned<double> grains_;  ///< standard deviation of the noise, grey levels
  std::optional<Eigen::Isometry3d> last_pose_;
  int last_index_ = 0;
  std::vector<float> azimuths_rad_;  ///< of the cameras about the object, one per frame
};

}  // namespace sheen::pipeline
