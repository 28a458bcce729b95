// SPDX-License-Identifier: MIT
#include "capture/session/camera_recording.h"
#include "capture/session/matroska_recording.h"
#include "capture/session/session.h"
#include "capture/source/ffmpeg_owners.h"
#include "capture/source/stream_clock.h"
#include "capture/source/video_source.h"
#include "tests/capture/power_cut.h"
#include "tests/capture/recording_frames.h"
#include "tests/capture/video_file.h"
#include "tests/support/full_disk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace sheen::capture::test {
namespace {

using tests::FullDisk;
using tests::TemporaryFolder;

constexpr int kStored = 40;

/// The pictures of a video by FFmpeg's encoder, which stores them out of their order, and what a
/// decoder needs.
struct StoredVideo {
  VideoHeader header;
  std::vector<LiveImage> pictures;
};

StoredVideo stored_video(const TemporaryFolder& folder, AVCodecID codec = AV_CODEC_ID_H264) {
  VideoSpec spec;
  spec.codec = codec;
  spec.format = AV_PIX_FMT_YUV420P;
  for (int i = 0; i < kStored; ++i) spec.stamps_ms.push_back(40 * i);
  spec.colour = [](int frame, bool is_right) -> Eigen::Vector3d {
    return Eigen::Vector3d::Constant(is_right ? 0.5 : 0.1 + 0.02 * frame);
  };
  const auto path = folder.path() / "encoded.mkv";
  write_video(path, spec);
  AVFormatContext* opened = nullptr;
  EXPECT_EQ(avformat_open_input(&opened, path.c_str(), nullptr, nullptr), 0);
  const InputPtr input(opened);
  const PacketPtr packet(av_packet_alloc());
  StoredVideo video;
  const AVCodecParameters& stated = *input->streams[0]->codecpar;
  video.header = {avcodec_get_name(stated.codec_id),
                  {stated.extradata, stated.extradata + stated.extradata_size}};
  while (av_read_frame(input.get(), packet.get()) >= 0) {
    video.pictures.push_back({std::make_shared<const std::vector<std::uint8_t>>(
                                  packet->data, packet->data + packet->size),
                              1000 * packet->pts, static_cast<std::uint32_t>(video.pictures.size()),
                              (packet->flags & AV_PKT_FLAG_KEY) != 0});
    av_packet_unref(packet.get());
  }
  return video;
}

/// A frame's number by its brightness, about 0.02 * 219 codes apart.
int number_of(const Frame& frame) {
  const double grey = cv::mean(frame.image(cv::Rect(4, 4, 24, 40)))[0] / 255;
  return static_cast<int>(std::lround((grey - 0.1) / 0.02));
}

/// Frames, which must be those from the first on, at their times.
int count_frames(FrameSource& source) {
  int count = 0;
  while (const auto frame = source.next()) {
    EXPECT_EQ(number_of(*frame), count);
    EXPECT_EQ(frame->index, count);
    EXPECT_NEAR(frame->time_s, 0.04 * count, 1e-9);
    ++count;
  }
  return count;
}

int count_frames(const std::filesystem::path& path) {
  return count_frames(*open_video(path, kRecordedSize, {}, std::nullopt));
}

TEST(MatroskaRecording, OpensWhereverItIsCut) {
  const TemporaryFolder folder;
  const StoredVideo video = stored_video(folder);
  const auto path = folder.path() / "recorded.mkv";
  MatroskaRecording recording(path, video.header, kRecordedSize);
  std::vector<std::uint64_t> ends;
  for (const LiveImage& picture : video.pictures) {
    ASSERT_EQ(recording.append(picture), 0);
    ends.push_back(recording.bytes());
    EXPECT_EQ(std::filesystem::file_size(path), recording.bytes());
  }
  // Killed now, and at any byte before.
  EXPECT_EQ(count_frames(path), kStored);
  const std::string bytes = tests::read_file(path);
  std::mt19937 random(5);
  for (int attempt = 0; attempt < 12; ++attempt) {
    const std::size_t size = ends[12] + random() % (bytes.size() - ends[12]);
    folder.write("cut.mkv", bytes.substr(0, size));
    const auto whole =
        static_cast<int>(std::upper_bound(ends.begin(), ends.end(), size) - ends.begin());
    // In their order only those whose predecessors are there, too: at most three come earlier.
    const auto source = open_video(folder.path() / "cut.mkv", kRecordedSize, {}, std::nullopt);
    int frames = 0;
    while (const auto frame = source->next()) {
      EXPECT_GE(number_of(*frame), frames);
      ++frames;
    }
    EXPECT_EQ(frames, whole) << size;
  }
  ASSERT_EQ(recording.close(), 0);
  EXPECT_EQ(count_frames(path), kStored);
}

// What was flushed is there, whatever of later writes came to the disk: those of more pictures, and
// of closing, which changes the beginning, too. Pictures wait for at most three stored after them.
TEST(MatroskaRecording, LosesNothingFlushedToAPowerCut) {
  const TemporaryFolder folder;
  const StoredVideo video = stored_video(folder);
  const auto path = folder.path() / "recorded.mkv";
  MatroskaRecording recording(path, video.header, kRecordedSize);
  std::vector<std::string> after;  // each picture
  for (const LiveImage& picture : video.pictures) {
    ASSERT_EQ(recording.append(picture), 0);
    after.push_back(tests::read_file(path));
  }
  ASSERT_EQ(recording.close(), 0);
  const std::string closed = tests::read_file(path);
  std::mt19937 random(7);
  for (int attempt = 0; attempt < 60; ++attempt) {
    const std::size_t flushed = 8 + random() % (kStored - 8);  // pictures
    const bool is_closing = attempt % 2 == 0;
    const std::size_t last = flushed + random() % (kStored - flushed);
    folder.write("cut.mkv",
                 after_power_cut(after[flushed - 1], is_closing ? closed : after[last], random));
    const auto source = open_video(folder.path() / "cut.mkv", kRecordedSize, {}, std::nullopt);
    for (int i = 0; i < static_cast<int>(flushed) - 3; ++i) {
      const auto frame = source->next();
      ASSERT_TRUE(frame) << "frame " << i << " of " << flushed << " flushed, attempt " << attempt;
      EXPECT_EQ(number_of(*frame), i) << attempt;
    }
  }
}

TEST(MatroskaRecording, TakesH265) {
  const TemporaryFolder folder;
  StoredVideo video;
  try {
    video = stored_video(folder, AV_CODEC_ID_HEVC);
  } catch (const std::runtime_error& missing) {
    GTEST_SKIP() << missing.what();
  }
  const auto path = folder.path() / "recorded.mkv";
  MatroskaRecording recording(path, video.header, kRecordedSize);
  for (const LiveImage& picture : video.pictures) ASSERT_EQ(recording.append(picture), 0);
  EXPECT_EQ(count_frames(path), kStored);
}

TEST(MatroskaRecording, DecodingTwiceGivesTheSameBytes) {
  const TemporaryFolder folder;
  const StoredVideo video = stored_video(folder);
  const auto path = folder.path() / "recorded.mkv";
  MatroskaRecording recording(path, video.header, kRecordedSize);
  for (const LiveImage& picture : video.pictures) ASSERT_EQ(recording.append(picture), 0);
  const auto once = open_video(path, kRecordedSize, {}, std::nullopt);
  const auto again = open_video(path, kRecordedSize, {}, std::nullopt);
  while (const auto frame = once->next()) {
    EXPECT_EQ(cv::norm(frame->image, again->next()->image, cv::NORM_INF), 0);
  }
}

/// Delivers stored pictures until it has none left, then only time passes.
class StoredCamera : public Camera {
 public:
  explicit StoredCamera(StoredVideo video) : video_(std::move(video)) {}

  std::optional<CameraBuffer> next(std::chrono::milliseconds /*timeout*/) override {
    if (next_ == video_.pictures.size()) return std::nullopt;
    const LiveImage& picture = video_.pictures[next_++];
    return CameraBuffer{PixelFormat::video,
                        *picture.bytes,
                        kRecordedSize.width_px,
                        kRecordedSize.height_px,
                        0,
                        100 + static_cast<double>(picture.time_us) / 1e6,
                        picture.sequence,
                        picture.is_key};
  }
  [[nodiscard]] CameraDescription description() const override {
    return {"Stored",
            "rtsp://stored",
            PixelFormat::video,
            kRecordedSize.width_px,
            kRecordedSize.height_px,
            25,
            video_.header};
  }
  [[nodiscard]] CameraCounts counts() const override { return {}; }

 private:
  StoredVideo video_;
  std::size_t next_ = 0;
};

TEST(LiveVideo, GivesTheFramesOfAReplay) {
  const TemporaryFolder folder;
  const StoredVideo video = stored_video(folder);
  SessionRecorder recorder(folder.path() / "walk", recording_setup(folder), 25, video.header);
  CameraRecording recording(std::make_unique<StoredCamera>(video), recorder, {.frames = kStored});
  const auto live = recording.frames();
  EXPECT_EQ(count_frames(*live), kStored);
  const Session session = open_session(folder.path() / "walk");
  EXPECT_EQ(session.video->filename(), "frames.mkv");
  EXPECT_EQ(count_frames(*open_frames(session)), kStored);
}

TEST(LiveVideo, AfterAFullDiskGivesWhatWasTaken) {
  const TemporaryFolder folder;
  const StoredVideo video = stored_video(folder);
  const auto path = folder.path() / "measured.mkv";
  MatroskaRecording measured(path, video.header, kRecordedSize);
  for (int i = 0; i < 20; ++i)
    ASSERT_EQ(measured.append(video.pictures[static_cast<std::size_t>(i)]), 0);
  SessionRecorder recorder(folder.path() / "walk", recording_setup(folder), 25, video.header);
  int reports = 0, frames = 0;
  {
    const FullDisk full(measured.bytes() + 5);  // the 21st meets it
    CameraRecording recording(std::make_unique<StoredCamera>(video), recorder,
                              {.on_disk_fault = [&](const core::Error&) { ++reports; }});
    const auto live = recording.frames();
    while (const auto frame = live->next()) ++frames;  // ends by itself
    const RecordingStatus status = recording.status();
    EXPECT_EQ(status.recorded, 20);
    EXPECT_TRUE(status.disk_fault);
    EXPECT_GE(frames, 21);
    EXPECT_LE(frames, status.taken);
  }
  EXPECT_EQ(reports, 1);
  const auto replayed = open_frames(open_session(folder.path() / "walk"));
  int kept = 0;
  while (replayed->next()) ++kept;
  EXPECT_EQ(kept, 20);
}

TEST(StreamClock, FindsTheDelayAndKeepsTheSpacing) {
  // 30 a second with delays of up to 60 ms, each as likely as the other, of a clock that is 1 in
  // 10,000 too fast and began anywhere.
  std::mt19937 random(4);
  std::uniform_real_distribution<double> delay(0, 0.06);
  StreamClock clock;
  double arrival_s = 0, before_s = 0, worst = 0;
  for (int i = 0; i < 3000; ++i) {
    const double taken_s = 100 + i / 30.0;
    arrival_s = std::max(arrival_s, taken_s + delay(random));
    const double stamp_s = 5000 + 1.0001 * (taken_s - 100);
    clock.note(stamp_s, arrival_s);
    const double time_s = clock.time_of(stamp_s);
    if (i > 0) {
      EXPECT_NEAR(time_s - before_s, 1 / 30.0, 0.0034);  // slower by a tenth at most
    }
    before_s = time_s;
    if (i >= 60) worst = std::max(worst, std::abs(time_s - taken_s));
  }
  // After two seconds. Raw arrivals are off by up to 60 ms, their mean by 30.
  EXPECT_LT(worst, 0.006);
}

TEST(StreamClock, GoesOnAfterAnotherConnectionAndAClockThatIsSet) {
  StreamClock clock;
  const auto time_of = [&](double stamp_s, double arrival_s) {
    clock.note(stamp_s, arrival_s);
    return clock.time_of(stamp_s);
  };
  EXPECT_DOUBLE_EQ(time_of(7, 100), 100);
  EXPECT_DOUBLE_EQ(time_of(8, 101), 101);
  clock.restart();
  EXPECT_DOUBLE_EQ(time_of(0, 103), 103);
  EXPECT_DOUBLE_EQ(time_of(1, 104), 104);
  EXPECT_DOUBLE_EQ(time_of(5000, 105), 105);
  clock.restart();
  EXPECT_GT(time_of(0, 104.9), 105);  // never back
}

TEST(StreamClock, PicturesStoredOutOfTheirOrderKeepIt) {
  // I P B B: stamps 0 3 1 2, times of arrival in the order of storage, delays that shrink.
  StreamClock clock;
  std::vector<std::pair<double, double>> times;
  double arrival_s = 50;
  for (int group = 0; group < 30; ++group) {
    for (const int place : {3, 1, 2}) {
      const double stamp_s = (3 * group + place) / 25.0;
      arrival_s += group < 15 ? 0.03 : 0.04;
      clock.note(stamp_s, arrival_s);
      times.emplace_back(stamp_s, clock.time_of(stamp_s));
    }
  }
  std::sort(times.begin(), times.end());
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i].second, times[i - 1].second);
}

}  // namespace
}  // namespace sheen::capture::test
