// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <vector>

namespace sheen::capture {

/// Poses of a recording in TUM form: one line per frame, `stamp tx ty tz qx qy qz qw`, the
/// transform board_from_camera in metres. Stamps are frame indices, or seconds when any has a
/// fraction.
class Trajectory {
 public:
  struct Entry {
    double stamp = 0;
    Eigen::Isometry3d board_from_camera = Eigen::Isometry3d::Identity();
  };

  Trajectory() = default;
  explicit Trajectory(std::vector<Entry> entries);

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

  /// Pose of a frame: by index, or for stamps in seconds the entry within half a frame (`1 / fps`).
  [[nodiscard]] std::optional<Eigen::Isometry3d> board_from_camera(const Frame& frame,
                                                                   double fps) const;

 private:
  std::vector<Entry> entries_;
  bool stamps_are_indices_ = true;
};

/// Throws core::Error (bad_input): unreadable lines, numbers that are not finite, zero quaternions,
/// a stamp twice.
Trajectory read_trajectory(const std::filesystem::path& path);
void write_trajectory(const std::filesystem::path& path,
                      const std::vector<Trajectory::Entry>& entries);

}  // namespace sheen::capture
