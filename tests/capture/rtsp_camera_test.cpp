// SPDX-License-Identifier: MIT
#include "capture/calibration/camera_images.h"
#include "capture/session/camera_recording.h"
#include "capture/session/session.h"
#include "capture/source/network_camera.h"
#include "capture/source/video_source.h"
#include "tests/capture/camera_refusal.h"
#include "tests/capture/recording_frames.h"
#include "tests/capture/rtsp_server.h"
#include "tests/capture/scripted_http.h"
#include "tests/capture/tcp_relay.h"
#include "tests/capture/video_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace sheen::capture::test {
namespace {

using namespace std::chrono_literals;
using tests::TemporaryFolder;
using Fault = TcpRelay::Fault;

constexpr int kServed = 48;  // a second, a picture that needs no others every twelve

NetworkCameraOptions hurried(const std::string& address) {
  return {.address = address, .answer_s = 5, .silence_s = 0.4, .reconnect_s = 0.5};
}

/// Noise, so that a picture of 64 x 48 takes some kilobytes, several packets of the network.
/// FFmpeg's encoder stores pictures out of their order.
std::filesystem::path noise_video(const TemporaryFolder& folder) {
  VideoSpec spec;
  spec.codec = AV_CODEC_ID_H264;
  spec.format = AV_PIX_FMT_YUV420P;
  for (int i = 0; i < kServed; ++i) spec.stamps_ms.push_back(20 * i);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> level(0.2, 0.8);
  spec.colour = [&](int, bool) -> Eigen::Vector3d {
    return Eigen::Vector3d::Constant(level(random));
  };
  const auto path = folder.path() / "served.mkv";
  write_video(path, spec);
  return path;
}

std::vector<Frame> all_frames(FrameSource& source) {
  std::vector<Frame> frames;
  while (auto frame = source.next()) frames.push_back(std::move(*frame));
  return frames;
}

std::vector<Frame> all_frames(const std::filesystem::path& video) {
  return all_frames(*open_video(video, kRecordedSize, {}, std::nullopt));
}

bool is_same(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_INF) == 0;
}

/// Which frame of the served file each one is; -1 for one that is none of them.
std::vector<int> numbers_of(const std::vector<Frame>& frames, const std::vector<Frame>& served) {
  std::vector<int> numbers;
  for (const Frame& frame : frames) {
    const auto found = std::find_if(served.begin(), served.end(), [&](const Frame& one) {
      return is_same(one.image, frame.image);
    });
    numbers.push_back(found == served.end() ? -1 : static_cast<int>(found - served.begin()));
  }
  return numbers;
}

/// A server for a file of noise; without GStreamer the tests are skipped.
class RtspCamera : public testing::Test {
 protected:
  void SetUp() override {
    if (server_.port() == 0) {
      GTEST_SKIP() << "gir1.2-gst-rtsp-server-1.0, python3-gi or GStreamer's plugins good and bad "
                      "are not installed";
    }
  }

  /// Records what comes until the camera fails or `pictures` are there. Live frames must be those
  /// that a replay gives.
  std::vector<Frame> record(int port, const RecordingTerms& terms, RecordingStatus& status) {
    auto camera = std::make_unique<NetworkCamera>(hurried(rtsp_address(port, "me:secret@")));
    const CameraDescription description = camera->description();
    SessionRecorder recorder(session_, recording_setup(folder_), 30, description.video);
    CameraRecording recording(std::move(camera), recorder, terms);
    const auto source = recording.frames();
    std::vector<Frame> live = all_frames(*source);
    recording.stop();
    status = recording.status();
    damaged_ = source->report().damaged;
    const auto replayed = all_frames(*open_frames(open_session(session_)));
    EXPECT_EQ(live.size(), replayed.size());
    for (std::size_t i = 0; i < std::min(live.size(), replayed.size()); ++i) {
      EXPECT_TRUE(is_same(live[i].image, replayed[i].image)) << i;
      EXPECT_EQ(live[i].time_s, replayed[i].time_s);
      EXPECT_EQ(live[i].index, replayed[i].index);
    }
    for (const auto& entry : std::filesystem::directory_iterator(session_)) {
      EXPECT_EQ(tests::read_file(entry.path()).find("secret"), std::string::npos) << entry.path();
    }
    return live;
  }

  TemporaryFolder folder_;
  std::filesystem::path session_ = folder_.path() / "session";
  std::filesystem::path video_ = noise_video(folder_);
  RtspServer server_{video_};
  std::vector<Frame> served_ = all_frames(video_);
  int damaged_ = 0;
};

TEST_F(RtspCamera, IsRecordedAsItCameAndReplaysExactly) {
  TcpRelay relay(server_.port(), {{}});
  RecordingStatus status;
  const auto frames = record(relay.port(), {}, status);
  ASSERT_TRUE(status.camera_fault);  // the file is over, and nobody answers any more
  EXPECT_EQ(std::string(status.camera_fault->what()).find("secret"), std::string::npos);
  EXPECT_EQ(status.description.video->codec, "h264");
  // Decoded, every picture is what it is in the file; the last one may hang in the network.
  const auto numbers = numbers_of(frames, served_);
  ASSERT_GE(numbers.size(), kServed - 1u);
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], static_cast<int>(i));
  EXPECT_EQ(damaged_, 0);
  // Times are the file's, 20 ms apart: the steady clock runs slower by a tenth at most while it
  // finds the delay, of up to 80 ms where pictures are stored before four others that they follow.
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_NEAR(frames[i].time_s - frames[i - 1].time_s, 0.020, 0.009) << i;
  }
}

TEST_F(RtspCamera, ACutInTheMiddleOfAPictureCostsThatPicture) {
  // The answers take about 1 kB and a picture as much: the cut is in the first second.
  TcpRelay relay(server_.port(), {{Fault::cut, 15'000}, {}});
  RecordingStatus status;
  const auto frames = record(relay.port(), {.frames = 30}, status);
  EXPECT_EQ(status.camera.reconnections, 1);
  const auto numbers = numbers_of(frames, served_);
  // From the beginning up to the cut, then the file from its beginning. The picture that was cut is
  // left out or, where enough of it came, has faults; the others are exact.
  EXPECT_EQ(numbers.front(), 0);
  EXPECT_LE(std::count(numbers.begin(), numbers.end(), -1), 1);
  const auto second = std::find(numbers.begin() + 1, numbers.end(), 0);
  ASSERT_NE(second, numbers.end());
  for (auto one = second; one != numbers.end(); ++one) EXPECT_EQ(*one, one - second);
}

TEST_F(RtspCamera, AStallAndGarbageAreGotOver) {
  TcpRelay relay(server_.port(), {{Fault::stall, 15'000}, {Fault::garbage, 15'000}, {}});
  RecordingStatus status;
  const auto frames = record(relay.port(), {.frames = 45}, status);
  EXPECT_EQ(status.camera.reconnections, 2);
  const auto numbers = numbers_of(frames, served_);
  EXPECT_EQ(std::count(numbers.begin(), numbers.end(), 0), 3);
  EXPECT_LE(std::count(numbers.begin(), numbers.end(), -1), 2);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(frames[i].time_s, frames[i - 1].time_s);
  }
}

TEST_F(RtspCamera, IsCalibratedFrom) {
  auto camera = std::make_unique<NetworkCamera>(hurried(rtsp_address(server_.port())));
  const auto images = open_camera_images(std::move(camera), 0.8);
  const auto numbers = numbers_of(all_frames(*images), served_);
  // Three a second, from the first on.
  EXPECT_EQ(numbers.front(), 0);
  EXPECT_GE(numbers.size(), 3u);
  EXPECT_EQ(std::count(numbers.begin(), numbers.end(), -1), 0);
}

TEST(RtspRefusals, WrongPasswordsAndPathsAreNamed) {
  const TemporaryFolder folder;
  const RtspServer server(noise_video(folder), true);
  if (server.port() == 0) GTEST_SKIP() << "gir1.2-gst-rtsp-server-1.0 is not installed";
  has(refusal(hurried(rtsp_address(server.port()))), "password");
  has(refusal(hurried(rtsp_address(server.port(), "me:secret2@"))), "password");
  std::string elsewhere = rtsp_address(server.port(), "me:secret@");
  elsewhere.replace(elsewhere.find("/video"), 6, "/audio");
  has(refusal(hurried(elsewhere)), "nothing under this path");
  NetworkCamera let_in(hurried(rtsp_address(server.port(), "me:secret@")));
  EXPECT_EQ(let_in.description().width_px, kRecordedSize.width_px);
}

/// Of a server that is none: what it sends whoever connects.
std::string refusal_of(const ScriptedHttp::Script& script) {
  ScriptedHttp server({script});
  std::string address = server.address("me:secret");
  address.replace(0, 4, "rtsp");
  NetworkCameraOptions options = hurried(address);
  options.answer_s = 0.5;
  return refusal(options);
}

TEST(RtspRefusals, AServerThatNeverAnswersOrIsNoneIsTold) {
  has(refusal_of([](HttpConnection& client) { client.wait_for_end(); }), "no answer");
  refusal_of([](HttpConnection& client) { client.send(std::string(100'000, 'x')); });
  refusal_of([](HttpConnection& client) {
    client.send("HTTP/1.0 200 OK\r\nContent-Type: text/html\r\n\r\n<html></html>");
  });
  std::mt19937 random(1);
  std::string noise;
  for (int i = 0; i < 100'000; ++i) noise += static_cast<char>(random());
  refusal_of([&](HttpConnection& client) { client.send(noise); });
  std::string address;
  {
    const ScriptedHttp nobody({});
    address = nobody.address("me:secret");
  }
  address.replace(0, 4, "rtsp");
  has(refusal(hurried(address)), "refuses the connection");
}

}  // namespace
}  // namespace sheen::capture::test
