// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session_recorder.h"
#include "capture/source/camera.h"
#include "capture/source/frame_source.h"
#include "capture/source/jpeg_encoder.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace sheen::capture {

/// When a recording ends by itself, and who hears of a disk that is full. Both functions are called
/// on the recording's thread and must not wait; they may be empty.
struct RecordingTerms {
  std::optional<int> frames = {};      ///< ends after this many images, >= 1
  std::optional<double> seconds = {};  ///< ends this long after the first image, > 0
  std::function<bool()> is_enough = {};
  std::function<void(const core::Error&)> on_disk_fault = {};
};

/// How a recording stands.
struct RecordingStatus {
  int taken = 0;       ///< images the camera delivered
  int recorded = 0;    ///< of these, in the file
  int dropped = 0;     ///< of these, lost because the disk was too slow
  int unreadable = 0;  ///< raw images with too few bytes
  CameraCounts camera;
  CameraDescription description;
  std::optional<core::Error> disk_fault;
  std::optional<core::Error> camera_fault;
  bool has_ended = false;
};

/// Camera -> recorder, on a thread that waits for the camera only: never for disk, fit or screen.
/// A full disk ends the recording, not the images.
class CameraRecording {
 public:
  /// The recorder is borrowed.
  CameraRecording(std::unique_ptr<Camera> camera, SessionRecorder& recorder, RecordingTerms terms);
  ~CameraRecording();
  CameraRecording(const CameraRecording&) = delete;
  CameraRecording& operator=(const CameraRecording&) = delete;
  CameraRecording(CameraRecording&&) = delete;
  CameraRecording& operator=(CameraRecording&&) = delete;

  /// Ends the recording and completes its files; the frames end after what was recorded.
  void stop();

  /// Every recorded frame, the way a replay reads it: from the file, as it grows. Whoever is slow
  /// catches up later. After a fault of the disk come all frames that were taken to be recorded;
  /// those taken later go on, unrecorded, and the oldest of them are dropped; of a compressed video
  /// none is taken later. `next` waits for frames. To be destroyed before the recording.
  [[nodiscard]] std::unique_ptr<FrameSource> frames();
  /// The same for one more reader, who takes nothing away from the first: only what is in the file,
  /// so it ends at a fault of the disk.
  [[nodiscard]] std::unique_ptr<FrameSource> recorded_frames();

  [[nodiscard]] RecordingStatus status() const;

 private:
  friend class LiveFrames;

  void record(const std::stop_token& stop);
  void take(const CameraBuffer& buffer);
  [[nodiscard]] bool is_over() const;
  bool report_disk_fault();
  std::optional<LiveImage> next_unrecorded();

  std::unique_ptr<Camera> camera_;
  SessionRecorder& recorder_;
  RecordingTerms terms_;
  JpegEncoder encoder_;
  std::optional<double> first_s_;  ///< these two: of the first and last image
  std::int64_t last_us_ = 0;
  bool has_disk_fault_ = false;
  bool needs_key_ = false;  ///< the last image is not recorded

  mutable std::mutex mutex_;
  std::condition_variable has_unrecorded_;
  RecordingStatus status_;
  /// After a fault of the disk, the newest images, which the recorder no longer takes. Filled by
  /// `thread_`, emptied by whoever calls `next` of `frames`: what is there when the camera ends is
  /// still delivered, and ends with the reader who leaves before. Older ones are not in the file,
  /// which the status tells (`taken` against `recorded`).
  std::deque<LiveImage> unrecorded_;
  std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace sheen::capture
