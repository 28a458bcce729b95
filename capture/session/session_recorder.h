// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/recorded_video.h"
#include "capture/source/camera.h"
#include "core/diagnostics/error.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace sheen::capture {

/// What a session says besides its frames. Board and mesh are copied; what is not known yet is
/// found from the recording later (open_unfinished_session).
struct SessionSetup {
  core::CameraModel camera;
  std::filesystem::path board;  ///< empty: not known yet
  std::filesystem::path mesh;   ///< empty: not known yet
  Eigen::Isometry3d board_from_object = Eigen::Isometry3d::Identity();
  bool camera_is_guessed = false;  ///< only the images' size is known of it; it is not written
};

/// Records a session that survives a crash. The folder opens as a session, unfinished where
/// something is not known, before the first image;
/// images and their time stamps are appended as they come and flushed to the disk twice a second.
/// After a crash all but the last second is there. Whoever adds images never waits for the disk:
/// one thread writes, another flushes.
class SessionRecorder {
 public:
  /// Makes the folder. Throws core::Error: bad_input when it holds something already or a part of
  /// `setup` cannot be read, run_failed when the disk is full.
  /// `video`: what the images are pictures of; nothing for JPEG images.
  SessionRecorder(const std::filesystem::path& folder, const SessionSetup& setup, double fps,
                  const std::optional<VideoHeader>& video = std::nullopt);
  ~SessionRecorder();
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;
  SessionRecorder(SessionRecorder&&) = delete;
  SessionRecorder& operator=(SessionRecorder&&) = delete;

  /// Takes an image to be written; false when it is not recorded: after a fault or `close`, or
  /// because the disk is so slow that too much waits already.
  bool add(LiveImage image);

  /// What ended the recording early, such as a full disk.
  [[nodiscard]] std::optional<core::Error> fault() const;

  /// Waits until image `index` is in the file and returns its time; nothing when it never will
  /// be.
  [[nodiscard]] std::optional<std::int64_t> wait_for(int index) const;

  /// Waits until the video's file holds more than `bytes` and returns how many; nothing when it
  /// never will.
  [[nodiscard]] std::optional<std::uint64_t> wait_for_more(std::uint64_t bytes) const;

  /// After a fault, once `wait_for` and `wait_for_more` have nothing more: the next of the images
  /// that were taken but never came to the disk, in the order of `add`; nothing when there is none.
  [[nodiscard]] std::optional<LiveImage> next_unwritten();

  /// Images in the file.
  [[nodiscard]] int written() const;

  /// Writes what waits and completes the file; nothing can be added any more.
  void close();

  [[nodiscard]] std::filesystem::path video() const { return folder_ / video_name_; }

 private:
  void write_all();
  [[nodiscard]] bool write(const LiveImage& image);
  void flush_until_stopped(const std::stop_token& stop);
  void flush();
  void set_fault(int fault);

  std::filesystem::path folder_;
  std::string video_name_;
  std::unique_ptr<RecordedVideo> video_;  ///< of the writing thread

  mutable std::mutex mutex_;
  mutable std::condition_variable has_news_;
  /// Filled by `add`, emptied by `writer_`. `close` lets the writer write all of it first; a fault
  /// of the disk stops the writer, and what waits goes to `next_unwritten`, the image that met the
  /// fault before the others. Without a reader it is lost with the recorder.
  std::deque<LiveImage> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool is_writing_ = false;               ///< an image is neither in `waiting_` nor in the file
  std::vector<std::int64_t> written_us_;  ///< times of the images in the file
  std::uint64_t written_bytes_ = 0;       ///< of the file
  std::optional<core::Error> fault_;
  bool is_closing_ = false;
  bool is_closed_ = false;

  std::condition_variable_any flush_pause_;
  std::mutex flush_mutex_;
  std::jthread writer_;  ///< last: they use all of the above
  std::jthread flusher_;
};

}  // namespace sheen::capture
