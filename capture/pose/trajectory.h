// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/edge_alignment.h"
#include "capture/source/frame.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <vector>

namespace sheen::capture {

/// What the stamps of poses count: frames from 0, or seconds since the first frame.
enum class Stamps { indices, seconds };

/// Poses of a recording in TUM form: one line per frame, `stamp tx ty tz qx qy qz qw`, the
/// transform board_from_camera in metres. Stamps are frame indices when all are written as whole
/// numbers, without a decimal point; otherwise seconds.
class Trajectory {
 public:
  struct Entry {
    double stamp = 0;
    Eigen::Isometry3d board_from_camera = Eigen::Isometry3d::Identity();
  };

  Trajectory() = default;
  /// Without a word about the stamps they are indices when all are whole.
  explicit Trajectory(std::vector<Entry> entries, std::optional<Stamps> stamps = std::nullopt);

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

  [[nodiscard]] Stamps stamps() const { return stamps_; }

  /// Pose of a frame: by index, or for stamps in seconds the nearest entry within half a frame:
  /// half of Frame::spacing_s, or of 1 / `fps` where the frame does not know.
  [[nodiscard]] std::optional<Eigen::Isometry3d> board_from_camera(const Frame& frame,
                                                                   double fps) const;

  /// How the board moves in the camera frame about then, a twist per second, from the entries
  /// before and after; no value where those are more than a quarter of a second apart.
  [[nodiscard]] std::optional<Twist> velocity(const Frame& frame, double fps) const;

 private:
  using Place = std::vector<Entry>::const_iterator;
  /// The end where no entry belongs to the frame.
  [[nodiscard]] Place place_of(const Frame& frame, double fps) const;

  std::vector<Entry> entries_;
  Stamps stamps_ = Stamps::indices;
};

/// Throws core::Error (bad_input): unreadable lines, numbers that are not finite, zero quaternions,
/// a stamp twice.
Trajectory read_trajectory(const std::filesystem::path& path);
void write_trajectory(const std::filesystem::path& path,
                      const std::vector<Trajectory::Entry>& entries);

}  // namespace sheen::capture
