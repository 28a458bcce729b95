// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/pose_estimator.h"
#include "capture/source/frame.h"
#include "core/geometry/camera.h"

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace sheen::capture {

/// Which file is at fault when the images' tags give no pose.
enum class PoseSuspect { board, camera, recording };

struct PoseCause {
  PoseSuspect suspect = PoseSuspect::recording;
  std::string fault;
  std::string remedy;
  bool is_sure = true;  ///< false where the images tell no cause
};

/// Finds out why the tags of a recording give no pose, from a few of its images: another family or
/// border, unknown ids, sizes that do not fit distances, turned or mirrored prints, another lens.
class BoardDiagnosis {
 public:
  BoardDiagnosis(const Board& board, const core::CameraModel& camera);
  ~BoardDiagnosis();
  BoardDiagnosis(const BoardDiagnosis&) = delete;
  BoardDiagnosis& operator=(const BoardDiagnosis&) = delete;

  void look_at(const Frame& frame);

  /// `refusal` is the most frequent reason for which frames were refused.
  [[nodiscard]] PoseCause cause(PoseRejection refusal) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::capture
