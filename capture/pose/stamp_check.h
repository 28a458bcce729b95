// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/trajectory.h"

#include <optional>
#include <string>

namespace sheen::capture {

/// The frames that poses were looked up for.
struct FrameSpan {
  int count = 0;
  int first_index = 0, last_index = 0;
  double first_s = 0, last_s = 0;
};

/// What is wrong with stamps, and what to do.
struct StampFault {
  std::string fault;
  std::string remedy;
};

/// Why no frame of a recording has a pose in its file: stamps of another clock, unit or count.
StampFault unmatched_stamps(const Trajectory& trajectory, const FrameSpan& frames);

/// Stamps in seconds that count frames: whole, one a second, past the recording's end, where the
/// frames take less than half of that. They give few frames a pose.
std::optional<StampFault> counting_stamps(const Trajectory& trajectory, const FrameSpan& frames);

/// Stamps from the first frame in milliseconds, microseconds or nanoseconds: over all of the
/// recording they run a thousand times (or more) as far as its frames. Whole ones count as indices
/// and give wrong frames a pose, a few.
std::optional<StampFault> finer_stamps(const Trajectory& trajectory, const FrameSpan& frames);

/// Stamps that name the wrong frames although they match: indices that count from 1 up to the
/// number of frames, which count from 0. `frames` is all of the recording.
std::optional<StampFault> shifted_stamps(const Trajectory& trajectory, int frames);

/// Indices that may be counts of something else: none for frame 0 where images are numbered from 1
/// or the indices begin with 1; or one after the other for the first half of the recording at most,
/// as counts of key frames are. `first_image` is the number of the first image, 0 of a video.
std::optional<StampFault> miscounting_stamps(const Trajectory& trajectory, const FrameSpan& frames,
                                             int first_image);

/// Stamps before the recording's first frame or after its last, a twentieth of them or more: of a
/// longer recording, another clock, another rate, or counts of something else.
std::optional<StampFault> stamps_outside(const Trajectory& trajectory, const FrameSpan& frames);

}  // namespace sheen::capture
