// SPDX-License-Identifier: MIT
#include "capture/pose/stamp_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sheen::capture {
namespace {

constexpr double kEpoch_s = 1e8;  // three years: no recording lasts as long

/// A clock that counts from 1970, by the size of its numbers.
struct EpochUnit {
  double least;
  const char* name;
  const char* divide;
};
constexpr std::array<EpochUnit, 4> kEpochUnits{{{1e17, "nanoseconds", " and divide by 1000000000"},
                                                {1e14, "microseconds", " and divide by 1000000"},
                                                {1e11, "milliseconds", " and divide by 1000"},
                                                {kEpoch_s, "seconds", ""}}};

/// A unit that is finer than the second, by how many of it a second holds.
struct FinerUnit {
  double per_second;
  const char* name;
};
constexpr std::array<FinerUnit, 3> kFinerUnits{
    {{1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}}};
constexpr double kFewOutside = 0.05;  // of the poses
constexpr double kSameSpan = 0.2;     // poses may begin later and end earlier than the frames

std::string range_text(double first, double last) {
  const bool is_whole = first == std::floor(first) && last == std::floor(last);
  return is_whole ? fmt::format("{:.0f} to {:.0f}", first, last)
                  : fmt::format("{:.6f} to {:.6f}", first, last);
}

std::string frames_text(const FrameSpan& frames, Stamps stamps) {
  if (stamps == Stamps::indices) {
    return fmt::format("the frames from {} to {}", frames.first_index, frames.last_index);
  }
  return fmt::format("the frames from {:.6g} to {:.6g} s", frames.first_s, frames.last_s);
}

std::string ranges_text(const Trajectory& trajectory, const FrameSpan& frames) {
  const auto& entries = trajectory.entries();
  const Stamps kind = trajectory.stamps();
  return fmt::format("its stamps run from {}{}, {}",
                     range_text(entries.front().stamp, entries.back().stamp),
                     kind == Stamps::seconds ? " s" : "", frames_text(frames, kind));
}

}  // namespace

StampFault unmatched_stamps(const Trajectory& trajectory, const FrameSpan& frames) {
  const auto& entries = trajectory.entries();
  if (entries.empty()) return {"holds no pose", "write one line for every frame"};
  const double first = entries.front().stamp, last = entries.back().stamp;
  const Stamps kind = trajectory.stamps();
  const std::string ranges = ranges_text(trajectory, frames);
  for (const EpochUnit& unit : kEpochUnits) {
    if (first < unit.least) continue;
    return {ranges + fmt::format(": they count {} since 1970", unit.name),
            fmt::format("seconds count from the first frame: subtract the first stamp{} and write "
                        "decimals",
                        unit.divide)};
  }
  if (auto finer = finer_stamps(trajectory, frames)) return std::move(*finer);
  if (kind == Stamps::indices) {
    return {ranges,
            "whole numbers are frame indices from 0; write seconds with decimals, such as 1.000"};
  }
  if (first > frames.last_s || last < frames.first_s) {
    return {ranges, "seconds count from the first frame: shift the stamps"};
  }
  return {ranges + ", and none lies within half a frame of a frame's time",
          "check \"fps\" in session.json against the clock of the poses"};
}

std::optional<StampFault> counting_stamps(const Trajectory& trajectory, const FrameSpan& frames) {
  const auto& entries = trajectory.entries();
  const int steps = frames.last_index - frames.first_index;
  if (trajectory.stamps() != Stamps::seconds || entries.size() < 3 || steps < 2) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].stamp != std::floor(entries[i].stamp)) return std::nullopt;
  }
  const double stamps_s = entries.back().stamp - entries.front().stamp;
  const double stamp_step_s = stamps_s / static_cast<double>(entries.size() - 1);
  const double frame_step_s = (frames.last_s - frames.first_s) / steps;
  if (stamp_step_s < 0.5 || frame_step_s > 0.5 * stamp_step_s) return std::nullopt;
  // A pose a second is allowed; past the recording's end there is none to give.
  if (entries.back().stamp < frames.last_s + stamp_step_s) return std::nullopt;
  return StampFault{fmt::format("its stamps run from {} s, one a second, {}",
                                range_text(entries.front().stamp, entries.back().stamp),
                                frames_text(frames, Stamps::seconds)),
                    "frame numbers are written without decimals"};
}

std::optional<StampFault> finer_stamps(const Trajectory& trajectory, const FrameSpan& frames) {
  const auto& entries = trajectory.entries();
  const double frames_s = frames.last_s - frames.first_s;
  if (entries.size() < 3 || !(frames_s > 0)) return std::nullopt;
  // Indices of frames that are there are indices, whatever their steps.
  if (trajectory.stamps() == Stamps::indices && entries.back().stamp <= frames.last_index) {
    return std::nullopt;
  }
  const double per_second = (entries.back().stamp - entries.front().stamp) / frames_s;
  for (const FinerUnit& unit : kFinerUnits) {
    if (std::abs(per_second / unit.per_second - 1) > kSameSpan) continue;
    return StampFault{
        fmt::format("{} ({:.3g} s): they are {}", ranges_text(trajectory, frames), frames_s,
                    unit.name),
        fmt::format("divide them by {:.0f} and write seconds with decimals, such as 1.000",
                    unit.per_second)};
  }
  return std::nullopt;
}

std::optional<StampFault> shifted_stamps(const Trajectory& trajectory, int frames) {
  const auto& entries = trajectory.entries();
  if (trajectory.stamps() != Stamps::indices || frames < 2) return std::nullopt;
  // Frames without a pose may be missing, the first one too.
  if (entries.empty() || entries.front().stamp < 1 || entries.back().stamp != frames) {
    return std::nullopt;
  }
  return StampFault{fmt::format("its stamps run from {:.0f} to {}, the frames from 0 to {}",
                                entries.front().stamp, frames, frames - 1),
                    "frames count from 0: take one off every stamp"};
}

std::optional<StampFault> miscounting_stamps(const Trajectory& trajectory, const FrameSpan& frames,
                                             int first_image) {
  const auto& entries = trajectory.entries();
  if (trajectory.stamps() != Stamps::indices || entries.size() < 2) return std::nullopt;
  const double first = entries.front().stamp, last = entries.back().stamp;
  if (first == 1 || (first > 1 && first_image == 1)) {
    return StampFault{fmt::format("its stamps begin with {:.0f}, and frame 0{} has no pose", first,
                                  first_image == 1 ? ", the image of number 1," : ""),
                      "frames count from 0: if the stamps count from 1, take one off every stamp"};
  }
  const auto poses = static_cast<int>(entries.size());
  if (first == 0 && last == poses - 1 && 2 * poses <= frames.last_index + 1) {
    return StampFault{
        fmt::format("gives the first {} of {} frames a pose and no other", poses,
                    frames.last_index + 1),
        "if its stamps count key frames, write the number of each one's frame in the recording"};
  }
  return std::nullopt;
}

std::optional<StampFault> stamps_outside(const Trajectory& trajectory, const FrameSpan& frames) {
  const auto& entries = trajectory.entries();
  const bool are_indices = trajectory.stamps() == Stamps::indices;
  // Seconds may differ from a frame's by half the time between two.
  const int steps = std::max(1, frames.last_index - frames.first_index);
  const double slack = are_indices ? 0 : (frames.last_s - frames.first_s) / steps;
  const double first = are_indices ? frames.first_index : frames.first_s;
  const double last = are_indices ? frames.last_index : frames.last_s;
  const auto outside = std::count_if(entries.begin(), entries.end(), [&](const auto& entry) {
    return entry.stamp < first - slack || entry.stamp > last + slack;
  });
  if (outside == 0 ||
      static_cast<double>(outside) < kFewOutside * static_cast<double>(entries.size())) {
    return std::nullopt;
  }
  return StampFault{
      fmt::format("{} of its {} poses belong to no frame: {}", outside, entries.size(),
                  ranges_text(trajectory, frames)),
      are_indices
          ? "stamps must be the frames' numbers in this recording, from 0"
          : "stamps must count seconds from this recording's first frame, at its true rate"};
}

}  // namespace sheen::capture
