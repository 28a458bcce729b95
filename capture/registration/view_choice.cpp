// SPDX-License-Identifier: MIT
#include "capture/registration/view_choice.h"

#include <algorithm>
#include <cstddef>

namespace sheen::capture {
namespace {

constexpr double kUnknownSpeed = 1e3;  // px per frame: no neighbour to compare with
constexpr double kSlowPx = 1.5;        // slower than this is nearly as good as standing still

/// Pixels per frame by which the point moves from one frame to another.
double speed_px(const PosedFrameIndex& a, const PosedFrameIndex& b, const core::CameraModel& camera,
                const Eigen::Vector3d& point_in_board) {
  const auto before = camera.project(a.camera_from_board * point_in_board);
  const auto after = camera.project(b.camera_from_board * point_in_board);
  const int frames = b.index - a.index;
  if (!before || !after || frames <= 0) return kUnknownSpeed;
  return (*after - *before).norm() / frames;
}

/// The faster of the motions before and after each frame.
std::vector<double> speeds_px(const std::vector<PosedFrameIndex>& frames,
                              const core::CameraModel& camera,
                              const Eigen::Vector3d& point_in_board) {
  std::vector<double> speeds(frames.size(), frames.size() > 1 ? 0 : kUnknownSpeed);
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    const double speed = speed_px(frames[i], frames[i + 1], camera, point_in_board);
    speeds[i] = std::max(speeds[i], speed);
    speeds[i + 1] = std::max(speeds[i + 1], speed);
  }
  return speeds;
}

}  // namespace

std::vector<ChosenView> choose_views(const std::vector<PosedFrameIndex>& frames,
                                     const core::CameraModel& camera,
                                     const Eigen::Vector3d& centre_in_board, int count) {
  if (frames.empty() || count < 1) return {};
  const std::vector<double> speeds = speeds_px(frames, camera, centre_in_board);

  // The slowest of each stretch.
  const std::size_t parts = std::min(frames.size(), static_cast<std::size_t>(count));
  std::vector<std::size_t> chosen;
  for (std::size_t part = 0; part < parts; ++part) {
    const auto begin = speeds.begin() + static_cast<std::ptrdiff_t>(part * speeds.size() / parts);
    const auto end =
        speeds.begin() + static_cast<std::ptrdiff_t>((part + 1) * speeds.size() / parts);
    chosen.push_back(static_cast<std::size_t>(std::min_element(begin, end) - speeds.begin()));
  }

  // Trust falls with the speed: the error of a rolling shutter grows with it.
  std::vector<ChosenView> views;
  double best = 0;
  for (const std::size_t i : chosen) {
    const double ratio = speeds[i] / kSlowPx;
    views.push_back({frames[i], 1 / (1 + ratio * ratio)});
    best = std::max(best, views.back().weight);
  }
  for (ChosenView& view : views) view.weight /= best;
  return views;
}

}  // namespace sheen::capture
