// SPDX-License-Identifier: MIT
#include "capture/session/session_recorder.h"

#include "capture/session/camera_recording.h"
#include "capture/session/frame_stamps.h"
#include "capture/session/new_session.h"
#include "capture/session/session.h"
#include "capture/source/avi_reader.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/capture/power_cut.h"
#include "tests/capture/recording_frames.h"
#include "tests/support/full_disk.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <future>
#include <new>
#include <random>

namespace sheen::capture::test {
namespace {

using tests::FullDisk;
using tests::TemporaryFolder;

constexpr int kFps = 30;
constexpr std::size_t kCameraBytes = 120'000;  // of an image at 1280x720

/// Frames of a session; they must be those that were put in, in order and on time.
int count_frames(const Session& session) {
  const auto source = open_frames(session);
  int frames = 0;
  while (const auto frame = source->next()) {
    EXPECT_EQ(frame->index, frames);
    EXPECT_EQ(recorded_index(frame->image), frames % 40);
    EXPECT_EQ(frame->time_s, stamp_seconds(live_image(frames).time_us));
    ++frames;
  }
  return frames;
}

TEST(SessionRecorder, IsASessionFromTheStart) {
  const TemporaryFolder scratch;
  const auto folder = scratch.path() / "walk";
  SessionRecorder recorder(folder, recording_setup(scratch), kFps);
  const Session session = open_session(folder);
  EXPECT_TRUE(session.warnings.empty());
  EXPECT_EQ(session.board_from_object.translation(), Eigen::Vector3d(0.5, 0, 0));
  EXPECT_EQ(session.camera.width_px(), kRecordedSize.width_px);
  expect_bad_input([&] { open_frames(session); }, "frames.csv", "has 0 frames");
}

TEST(SessionRecorder, KeepsEveryByteAndTime) {
  const TemporaryFolder scratch;
  const auto folder = scratch.path() / "walk";
  SessionRecorder recorder(folder, recording_setup(scratch), kFps);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(recorder.add(live_image(i)));
  // Before and after the end.
  ASSERT_EQ(recorder.wait_for(49), live_image(49).time_us);
  EXPECT_EQ(count_frames(open_session(folder)), 50);
  recorder.close();
  EXPECT_EQ(count_frames(open_session(folder)), 50);
  EXPECT_FALSE(recorder.fault());
  EXPECT_FALSE(recorder.wait_for(50));
  EXPECT_FALSE(recorder.add(live_image(50)));

  auto reader = AviReader::open(folder / "frames.avi");
  EXPECT_EQ(reader->header().frames, 50);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(reader->advance());
    const auto bytes = reader->read();
    EXPECT_EQ(std::vector(bytes.begin(), bytes.end()), recorded_jpeg(i));
  }
}

TEST(SessionRecorder, RefusesToWriteOverSomething) {
  const TemporaryFolder scratch;
  scratch.write("walk/precious.txt", "mine");
  const SessionSetup setup = recording_setup(scratch);
  expect_bad_input([&] { SessionRecorder(scratch.path() / "walk", setup, kFps); }, "walk",
                   "exists already");
  SessionSetup without_mesh = setup;
  without_mesh.mesh = scratch.path() / "absent.ply";
  expect_bad_input([&] { SessionRecorder(scratch.path() / "other", without_mesh, kFps); },
                   "absent.ply");
  EXPECT_FALSE(std::filesystem::exists(scratch.path() / "other"));
}

TEST(SessionRecorder, RecordsAWalkOfWhichNothingIsKnown) {
  const TemporaryFolder scratch;
  const auto folder = scratch.path() / "walk";
  {
    SessionRecorder recorder(
        folder,
        {.camera = make_camera(kRecordedSize.width_px, kRecordedSize.height_px, false),
         .board = {},
         .mesh = {},
         .camera_is_guessed = true},
        kFps);
    ASSERT_TRUE(recorder.add(live_image(0)));
    ASSERT_TRUE(recorder.wait_for(0));
    // It opens, unfinished as it is, while it is being recorded.
    const Session session = open_unfinished_session(folder);
    EXPECT_FALSE(session.camera_file);
    EXPECT_FALSE(session.board);
    EXPECT_TRUE(session.mesh.empty());
    EXPECT_EQ(session.camera.width_px(), kRecordedSize.width_px);
  }
  EXPECT_EQ(count_frames(open_unfinished_session(folder)), 1);
}

/// Records until it is killed, never more than a second ahead of the file; reports every image that
/// it has handed in. Runs in a process of its own.
[[noreturn]] void record_for_ever(const std::filesystem::path& folder, const SessionSetup& setup,
                                  int reports) {
  SessionRecorder recorder(folder, setup, kFps);
  for (int i = 0;; ++i) {
    if (!recorder.add(live_image(i, kCameraBytes))) _exit(1);
    if (i >= kFps && !recorder.wait_for(i - kFps)) _exit(1);
    if (write(reports, "x", 1) != 1) _exit(1);
  }
}

// What `wait_for` has told to be in the file is there after a kill, and opens.
TEST(SessionRecorder, LosesLessThanASecondToAKill) {
  const TemporaryFolder scratch;
  const SessionSetup setup = recording_setup(scratch);
  std::mt19937 random(17);
  for (int attempt = 0; attempt < 10; ++attempt) {
    const auto folder = scratch.path() / std::to_string(attempt);
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) record_for_ever(folder, setup, ends[1]);
    close(ends[1]);
    const int handed_in = 35 + static_cast<int>(random() % 40);
    for (int i = 0; i < handed_in; ++i) {
      char report = 0;
      ASSERT_EQ(read(ends[0], &report, 1), 1);
    }
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(ends[0]);
    // All but a second of images; more than were reported may have come.
    EXPECT_GE(count_frames(open_session(folder)), handed_in - kFps) << "attempt " << attempt;
  }
}

TEST(SessionRecorder, OpensWhateverTheEndLooksLike) {
  const TemporaryFolder scratch;
  const auto folder = scratch.path() / "walk";
  {
    SessionRecorder recorder(folder, recording_setup(scratch), kFps);
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(recorder.add(live_image(i)));
    ASSERT_TRUE(recorder.wait_for(29));
    // As it is before it is closed.
    std::filesystem::copy(folder, scratch.path() / "open",
                          std::filesystem::copy_options::recursive);
  }
  const auto append = [&](const char* file, const std::string& bytes) {
    std::ofstream(scratch.path() / "open" / file, std::ios::binary | std::ios::app) << bytes;
  };
  append("frames.avi", "00dc\xff\xff");
  append("frames.csv", "30,1.0");
  EXPECT_EQ(count_frames(open_session(scratch.path() / "open")), 30);
  append("frames.avi", std::string(4000, '\xfe'));
  append("frames.csv", "0000,35\n" + std::string(100, '\0'));
  EXPECT_EQ(count_frames(open_session(scratch.path() / "open")), 31 - 1);
  // Fewer stamps than images, then fewer images than stamps.
  std::filesystem::resize_file(scratch.path() / "open" / "frames.csv", 300);
  const int stamped = count_frames(open_session(scratch.path() / "open"));
  EXPECT_GT(stamped, 5);
  EXPECT_LT(stamped, 30);
  std::filesystem::resize_file(scratch.path() / "open" / "frames.avi", 8000);
  const int with_images = count_frames(open_session(scratch.path() / "open"));
  EXPECT_GT(with_images, 0);
  EXPECT_LT(with_images, stamped);
}

TEST(SessionRecorder, KeepsWhatWasRecordedWhenTheDiskIsFull) {
  const TemporaryFolder scratch;
  const auto folder = scratch.path() / "walk";
  SessionRecorder recorder(folder, recording_setup(scratch), kFps);
  int fitted = 0;
  {
    // Room for the headers and 7 images.
    const FullDisk full(5000 + 7 * (kCameraBytes + 10) + kCameraBytes / 2);
    for (int i = 0; i < 20; ++i) recorder.add(live_image(i, kCameraBytes));
    while (recorder.wait_for(fitted)) ++fitted;  // to the fault
    recorder.close();
  }
  EXPECT_EQ(fitted, 7);
  ASSERT_TRUE(recorder.fault());
  EXPECT_NE(std::string(recorder.fault()->what()).find("recording has stopped"), std::string::npos);
  EXPECT_FALSE(recorder.add(live_image(20)));
  EXPECT_EQ(count_frames(open_session(folder)), 7);
}

TEST(SessionRecorder, GivesBackWhatItTookAndCouldNotWrite) {
  // The writer may be slow or fast; in any order what was taken is written or given back. Attempts
  // go on until images waited behind the one that met the full disk.
  const TemporaryFolder scratch;
  const SessionSetup setup = recording_setup(scratch);
  std::vector<LiveImage> images;
  for (int i = 0; i < 20; ++i) images.push_back(live_image(i, kCameraBytes));
  bool some_waited = false;
  for (int attempt = 0; attempt < 200 && !some_waited; ++attempt) {
    const auto folder = scratch.path() / std::to_string(attempt);
    SessionRecorder recorder(folder, setup, kFps);
    const FullDisk full(5000 + 7 * (kCameraBytes + 10) + kCameraBytes / 2);
    int taken = 0;
    while (taken < 20 && recorder.add(images[static_cast<std::size_t>(taken)])) ++taken;
    int seen = 0;
    while (recorder.wait_for(seen)) ++seen;
    EXPECT_EQ(seen, 7);
    while (const auto image = recorder.next_unwritten()) {
      EXPECT_EQ(image->time_us, live_image(seen).time_us);
      ++seen;
    }
    EXPECT_EQ(seen, taken);
    some_waited = taken > 8;  // the eighth met the full disk
  }
  EXPECT_TRUE(some_waited);
}

/// Delivers numbered images until it has none left, then only time passes.
class CountingCamera : public Camera {
 public:
  explicit CountingCamera(int images) : images_(images) {}

  std::optional<CameraBuffer> next(std::chrono::milliseconds /*timeout*/) override {
    if (next_ == images_) return std::nullopt;
    bytes_ = recorded_jpeg(next_, kCameraBytes);
    const int index = next_++;
    return CameraBuffer{PixelFormat::mjpeg,
                        bytes_,
                        kRecordedSize.width_px,
                        kRecordedSize.height_px,
                        0,
                        100 + index / 30.0,
                        static_cast<std::uint32_t>(index)};
  }
  [[nodiscard]] CameraDescription description() const override {
    return {"Counter",
            "/dev/counter",
            PixelFormat::mjpeg,
            kRecordedSize.width_px,
            kRecordedSize.height_px,
            kFps};
  }
  [[nodiscard]] CameraCounts counts() const override { return {}; }

 private:
  int images_;
  int next_ = 0;
  std::vector<std::uint8_t> bytes_;
};

TEST(CameraRecording, GivesEveryFrameToWhoeverIsSlow) {
  const TemporaryFolder scratch;
  const auto folder = scratch.path() / "walk";
  SessionRecorder recorder(folder, recording_setup(scratch), kFps);
  CameraRecording recording(std::make_unique<CountingCamera>(90), recorder, {.frames = 80});
  // Somebody keeps up to the end.
  const auto prompt = recording.frames();
  for (int i = 0; i < 80; ++i) ASSERT_TRUE(prompt->next());
  EXPECT_FALSE(prompt->next());
  EXPECT_TRUE(recording.status().has_ended);
  EXPECT_EQ(recording.status().recorded, 80);
  // The slowest of all starts only then.
  const auto live = recording.frames();
  const auto replayed = open_frames(open_session(folder));
  for (int i = 0; i < 80; ++i) {
    const auto frame = live->next();
    const auto again = replayed->next();
    ASSERT_TRUE(frame && again);
    EXPECT_EQ(frame->index, again->index);
    EXPECT_EQ(frame->time_s, again->time_s);
    EXPECT_EQ(cv::norm(frame->image, again->image, cv::NORM_INF), 0);
  }
  EXPECT_FALSE(live->next());
  EXPECT_FALSE(replayed->next());
}

TEST(CameraRecording, GoesOnWithoutTheDisk) {
  const TemporaryFolder scratch;
  const auto folder = scratch.path() / "walk";
  SessionRecorder recorder(folder, recording_setup(scratch), kFps);
  int reports = 0;
  int last_index = -1, frames = 0;
  {
    const FullDisk full(5000 + 7 * (kCameraBytes + 10) + kCameraBytes / 2);
    CameraRecording recording(
        std::make_unique<CountingCamera>(40), recorder,
        {.frames = 40, .on_disk_fault = [&](const core::Error&) { ++reports; }});
    const auto live = recording.frames();
    while (const auto frame = live->next()) {
      EXPECT_EQ(frame->index, last_index + 1);
      last_index = frame->index;
      ++frames;
    }
    EXPECT_EQ(recording.status().taken, 40);
    EXPECT_EQ(recording.status().recorded, 7);
  }
  EXPECT_EQ(reports, 1);
  EXPECT_GT(frames, 7);  // the image that met the full disk at least
  EXPECT_EQ(count_frames(open_session(folder)), 7);
}

TEST(CameraRecording, TellsAFullDiskWhileTheCameraIsSilent) {
  const TemporaryFolder scratch;
  SessionRecorder recorder(scratch.path() / "walk", recording_setup(scratch), kFps);
  std::promise<void> told;
  const FullDisk full(5000 + 7 * (kCameraBytes + 10) + kCameraBytes / 2);
  // The eighth image meets the full disk, and no other comes.
  CameraRecording recording(std::make_unique<CountingCamera>(8), recorder,
                            {.on_disk_fault = [&](const core::Error&) { told.set_value(); }});
  EXPECT_EQ(told.get_future().wait_for(std::chrono::seconds(20)), std::future_status::ready);
}

TEST(CameraRecording, ReportsAFaultThatIsFoundAfterTheLastImage) {
  constexpr int images = 12;
  const TemporaryFolder scratch;
  const SessionSetup setup = recording_setup(scratch);
  // As many bytes as the images take, so that the index at the end finds no room.
  std::uintmax_t bytes = 0;
  {
    SessionRecorder recorder(scratch.path() / "first", setup, kFps);
    for (int i = 0; i < images; ++i) ASSERT_TRUE(recorder.add(live_image(i, kCameraBytes)));
    ASSERT_TRUE(recorder.wait_for(images - 1));
    bytes = std::filesystem::file_size(scratch.path() / "first" / "frames.avi");
  }
  const auto folder = scratch.path() / "walk";
  SessionRecorder recorder(folder, setup, kFps);
  int reports = 0;
  int frames = 0;
  {
    const FullDisk full(bytes);
    CameraRecording recording(
        std::make_unique<CountingCamera>(images), recorder,
        {.frames = images, .on_disk_fault = [&](const core::Error&) { ++reports; }});
    const auto live = recording.frames();
    while (live->next()) ++frames;
    recording.stop();
    EXPECT_TRUE(recording.status().disk_fault);
  }
  EXPECT_EQ(frames, images);
  EXPECT_EQ(reports, 1);
  EXPECT_EQ(count_frames(open_session(folder)), images);
}

/// Runs out of memory at image 3.
class GreedyCamera : public CountingCamera {
 public:
  GreedyCamera() : CountingCamera(5) {}
  std::optional<CameraBuffer> next(std::chrono::milliseconds timeout) override {
    if (asked_++ == 3) throw std::bad_alloc();
    return CountingCamera::next(timeout);
  }

 private:
  int asked_ = 0;
};

TEST(CameraRecording, KeepsWhatItHasWhenMemoryIsUsedUp) {
  const TemporaryFolder scratch;
  const auto folder = scratch.path() / "walk";
  SessionRecorder recorder(folder, recording_setup(scratch), kFps);
  CameraRecording recording(std::make_unique<GreedyCamera>(), recorder, {});
  const auto live = recording.frames();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(live->next());
  EXPECT_FALSE(live->next());
  EXPECT_TRUE(recording.status().camera_fault);
  EXPECT_EQ(count_frames(open_session(folder)), 3);
}

TEST(CameraRecording, EndsWhenItIsToldTo) {
  const TemporaryFolder scratch;
  SessionRecorder recorder(scratch.path() / "walk", recording_setup(scratch), kFps);
  CameraRecording recording(std::make_unique<CountingCamera>(5), recorder, {});
  const auto live = recording.frames();
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(live->next());
  recording.stop();
  EXPECT_FALSE(live->next());
  EXPECT_TRUE(recording.status().has_ended);
}

TEST(FrameStamps, RefusesWhatIsNoSuchFile) {
  const TemporaryFolder scratch;
  const auto expect = [&](const std::string& text, const char* word) {
    const auto path = scratch.write("frames.csv", text);
    expect_bad_input([&] { read_stamps(path); }, "frames.csv", word);
  };
  const std::string heading = stamps_heading();
  expect("", "begin");
  expect("time\n", "begin");
  expect(heading + "0,0.0,0\nx,1.0,1\n2,2.0,2\n", "line 3");
  expect(heading + "0,0.0,0\n2,1.0,1\n", "line 3");
  expect(heading + "0,nan,0\n1,1.0,1\n", "line 2");
  expect(heading + "0,-1.0,0\n", "line 2");
  expect(heading + "0,1.0,0\n1,0.5,1\n", "back in time");
  const auto path = scratch.write(
      "frames.csv", heading + stamp_line(0, 0, 4) + stamp_line(1, 3'600'033'312, 5) + "2,3");
  EXPECT_EQ(read_stamps(path), (std::vector<double>{0, stamp_seconds(3'600'033'312)}));
}

// Blocks of later lines may have come to the disk and earlier ones not: what was flushed counts.
TEST(FrameStamps, LoseNothingFlushedToAPowerCut) {
  const TemporaryFolder scratch;
  std::string text = stamps_heading();
  std::vector<std::size_t> ends;
  std::vector<double> times_s;
  for (int i = 0; i < 300; ++i) {
    const std::int64_t time_us = 33'333LL * i;
    text += stamp_line(i, time_us, static_cast<std::uint32_t>(i));
    ends.push_back(text.size());
    times_s.push_back(stamp_seconds(time_us));
  }
  std::mt19937 random(3);
  for (int attempt = 0; attempt < 200; ++attempt) {
    const std::size_t flushed = 1 + random() % (ends.size() - 1);  // lines
    const auto path = scratch.write(
        "frames.csv", after_power_cut(text.substr(0, ends[flushed - 1]), text, random));
    const auto left = read_stamps(path);
    ASSERT_GE(left.size(), flushed) << attempt;
    EXPECT_TRUE(std::equal(left.begin(), left.end(), times_s.begin())) << attempt;
  }
}

}  // namespace
}  // namespace sheen::capture::test
