// SPDX-License-Identifier: MIT
#include "capture/session/session_recorder.h"

#include "capture/calibration/camera_file.h"
#include "capture/session/jpeg_recording.h"
#include "capture/session/matroska_recording.h"
#include "capture/session/session_file.h"
#include "core/files/staged_output.h"

#include <chrono>
#include <system_error>
#include <utility>

namespace sheen::capture {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostWaitingBytes = std::size_t{256} << 20;
constexpr auto kFlushPause =
    std::chrono::milliseconds(500);  // loses at most a second with its work

void refuse_existing(const fs::path& folder) {
  std::error_code no_throw;
  if (!fs::exists(folder, no_throw) || fs::is_empty(folder, no_throw)) return;
  throw core::bad_input(folder, "exists already", "choose another name for the recording");
}

/// What is known besides the images.
SessionFile write_setup(const fs::path& folder, const SessionSetup& setup) {
  SessionFile session{.camera = {}, .mesh = {}, .board_from_object = setup.board_from_object};
  if (!setup.camera_is_guessed) {
    session.camera = "camera.yaml";
    write_camera(folder / session.camera, setup.camera);
  }
  if (!setup.board.empty()) {
    session.board = "board.yaml";
    copy_into_session(setup.board, folder / *session.board);
  }
  if (!setup.mesh.empty()) {
    session.mesh = "object" + setup.mesh.extension().string();
    copy_into_session(setup.mesh, folder / session.mesh);
  }
  return session;
}

}  // namespace

SessionRecorder::SessionRecorder(const fs::path& folder, const SessionSetup& setup, double fps,
                                 const std::optional<VideoHeader>& video)
    : folder_(folder), video_name_(video ? "frames.mkv" : "frames.avi") {
  refuse_existing(folder);
  // The folder appears complete; the open files move with it.
  core::StagedOutput staged(folder);
  fs::create_directories(staged.path());
  SessionFile session = write_setup(staged.path(), setup);
  session.video = video_name_;
  const ImageSize size{setup.camera.width_px(), setup.camera.height_px()};
  const fs::path path = staged.path() / video_name_;
  if (video) {
    video_ = std::make_unique<MatroskaRecording>(path, *video, size);
  } else {
    session.stamps = "frames.csv";
    video_ = std::make_unique<JpegRecording>(path, staged.path() / *session.stamps, size, fps);
  }
  written_bytes_ = video_->bytes();
  write_session_file(staged.path(), session);
  staged.commit();  // on the disk before the first image

  writer_ = std::jthread([this] { write_all(); });
  flusher_ = std::jthread([this](const std::stop_token& stop) { flush_until_stopped(stop); });
}

SessionRecorder::~SessionRecorder() {
  close();
}

bool SessionRecorder::add(LiveImage image) {
  {
    const std::lock_guard lock(mutex_);
    const std::size_t bytes = image.bytes->size();
    if (fault_ || is_closing_ || waiting_bytes_ + bytes > kMostWaitingBytes) return false;
    waiting_bytes_ += bytes;
    waiting_.push_back(std::move(image));
  }
  has_news_.notify_all();
  return true;
}

std::optional<core::Error> SessionRecorder::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

std::optional<std::int64_t> SessionRecorder::wait_for(int index) const {
  std::unique_lock lock(mutex_);
  const auto place = static_cast<std::size_t>(index);
  const auto none_will_come = [&] { return (fault_ && !is_writing_) || is_closed_; };
  has_news_.wait(lock, [&] { return place < written_us_.size() || none_will_come(); });
  if (place < written_us_.size()) return written_us_[place];
  return std::nullopt;
}

std::optional<std::uint64_t> SessionRecorder::wait_for_more(std::uint64_t bytes) const {
  std::unique_lock lock(mutex_);
  const auto none_will_come = [&] { return (fault_ && !is_writing_) || is_closed_; };
  has_news_.wait(lock, [&] { return bytes < written_bytes_ || none_will_come(); });
  if (bytes < written_bytes_) return written_bytes_;
  return std::nullopt;
}

std::optional<LiveImage> SessionRecorder::next_unwritten() {
  const std::lock_guard lock(mutex_);
  if (!fault_ || is_writing_ || waiting_.empty()) return std::nullopt;
  LiveImage image = std::move(waiting_.front());
  waiting_.pop_front();
  waiting_bytes_ -= image.bytes->size();
  return image;
}

int SessionRecorder::written() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(written_us_.size());
}

void SessionRecorder::close() {
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = true;
  }
  has_news_.notify_all();
  if (writer_.joinable()) writer_.join();
  flusher_.request_stop();
  if (flusher_.joinable()) flusher_.join();
}

void SessionRecorder::write_all() {
  while (true) {
    LiveImage image;
    {
      std::unique_lock lock(mutex_);
      has_news_.wait(lock, [&] { return !waiting_.empty() || is_closing_ || fault_; });
      if (waiting_.empty() || fault_) break;
      image = std::move(waiting_.front());
      waiting_.pop_front();
      is_writing_ = true;
    }
    const bool is_written = write(image);
    {
      const std::lock_guard lock(mutex_);
      is_writing_ = false;
      if (is_written) {
        waiting_bytes_ -= image.bytes->size();
        written_us_.push_back(image.time_us);
        written_bytes_ = video_->bytes();
      } else {
        waiting_.push_front(std::move(image));  // it was taken, so somebody gets it
      }
    }
    has_news_.notify_all();
  }
  if (!fault()) {
    if (const int status = video_->close(); status != 0) set_fault(status);
    flush();
  }
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }
  has_news_.notify_all();
}

bool SessionRecorder::write(const LiveImage& image) {
  const int status = video_->append(image);
  if (status != 0) set_fault(status);
  return status == 0;
}

void SessionRecorder::flush_until_stopped(const std::stop_token& stop) {
  std::unique_lock lock(flush_mutex_);
  while (!flush_pause_.wait_for(lock, stop, kFlushPause, [] { return false; })) {
    if (stop.stop_requested()) return;
    flush();
  }
}

void SessionRecorder::flush() {
  if (const int status = video_->flush(); status != 0) set_fault(status);
}

void SessionRecorder::set_fault(int fault) {
  {
    const std::lock_guard lock(mutex_);
    if (!fault_) {
      fault_ = core::Error(core::Error::Kind::run_failed, folder_,
                           "recording has stopped: " + std::generic_category().message(fault),
                           "what was recorded is kept; free disk space and record again");
    }
  }
  has_news_.notify_all();
}

}  // namespace sheen::capture
