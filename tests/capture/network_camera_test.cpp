// SPDX-License-Identifier: MIT
#include "capture/source/network_camera.h"

#include "capture/session/camera_recording.h"
#include "capture/source/arrival_clock.h"
#include "capture/source/network_address.h"
#include "capture/source/open_camera.h"
#include "tests/capture/camera_refusal.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/capture/recording_frames.h"
#include "tests/capture/scripted_http.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sheen::capture::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kLong = 20s;  // a test that waits as long has failed

/// Short times, so that silence is over soon. A script sends its images as fast as it can: none of
/// them counts as stale.
NetworkCameraOptions hurried(const std::string& address, double answer_s = 3) {
  return {.address = address, .answer_s = answer_s, .silence_s = 1, .reconnect_s = 1, .stale_s = 0};
}

void send_images(HttpConnection& client, int first, int count, bool with_length = true) {
  for (int i = first; i < first + count; ++i) {
    if (!client.send_image(recorded_jpeg(i), with_length)) return;
  }
}

std::vector<std::uint8_t> bytes_of(const CameraBuffer& buffer) {
  return {buffer.bytes.begin(), buffer.bytes.end()};
}

/// Number of every image until the camera fails, whose error is kept.
std::vector<int> all_images(NetworkCamera& camera, std::string& fault) {
  std::vector<int> numbers;
  try {
    while (true) {
      const auto buffer = camera.next(kLong);
      if (!buffer) break;
      int number = -1;
      for (int i = 0; i < 40; ++i) {
        if (bytes_of(*buffer) == recorded_jpeg(i)) number = i;
      }
      numbers.push_back(number);
    }
  } catch (const core::Error& error) {
    fault = error.what();
  }
  return numbers;
}

std::vector<int> numbers_from(int first, int last) {
  std::vector<int> numbers;
  for (int i = first; i <= last; ++i) numbers.push_back(i);
  return numbers;
}

TEST(ShownAddress, HoldsNoCredentials) {
  EXPECT_EQ(shown_address("http://10.0.0.7:8080/video"), "http://10.0.0.7:8080/video");
  EXPECT_EQ(shown_address("http://me:secret@phone:8080/video"), "http://phone:8080/video");
  EXPECT_EQ(shown_address("http://me:se@cret@phone/video"), "http://phone/video");
  EXPECT_EQ(shown_address("http://phone/video?user=me&pwd=secret"), "http://phone/video");
  EXPECT_EQ(shown_address("http://me:se/cret@phone/video"), "http://...");
  EXPECT_EQ(shown_address("rtsp://me:secret@phone"), "rtsp://phone");
  EXPECT_EQ(shown_address("rtsp://cam/user=me_password=secret_channel=1.sdp"), "rtsp://cam");
  EXPECT_EQ(shown_address("/dev/video0"), "/dev/video0");
}

TEST(NetworkCamera, DeliversEveryImageByteForByte) {
  ScriptedHttp server({[](HttpConnection& client) {
    client.begin_images();
    send_images(client, 0, 30);
  }});
  NetworkCamera camera(hurried(server.address("me:secret")));
  EXPECT_EQ(camera.description().width_px, kRecordedSize.width_px);
  EXPECT_EQ(camera.description().height_px, kRecordedSize.height_px);
  EXPECT_EQ(camera.description().device.find("secret"), std::string::npos);
  std::string fault;
  const std::vector<int> images = all_images(camera, fault);
  EXPECT_EQ(images, numbers_from(0, 29));  // all that arrived, before the fault
  has(fault, "127.0.0.1");
  EXPECT_EQ(fault.find("secret"), std::string::npos);
}

TEST(NetworkCamera, FindsImagesWithoutTheirLengthBetweenBoundaries) {
  ScriptedHttp server({[](HttpConnection& client) {
    client.begin_images();
    send_images(client, 0, 30, false);
  }});
  NetworkCamera camera(hurried(server.address()));
  std::string fault;
  const std::vector<int> images = all_images(camera, fault);
  // libavformat looks for boundaries in pieces of 2 KiB: what a connection that ends leaves of the
  // last piece, up to three images of 650 bytes, is not seen any more.
  ASSERT_GE(images.size(), 27u);
  EXPECT_EQ(images, numbers_from(0, static_cast<int>(images.size()) - 1));
}

TEST(NetworkCamera, TimesIncreaseAndImagesAreCounted) {
  ScriptedHttp server({[](HttpConnection& client) {
    client.begin_images();
    send_images(client, 0, 30);
  }});
  NetworkCamera camera(hurried(server.address()));
  double before_s = 0;
  std::uint32_t sequence = 0;
  try {
    while (const auto buffer = camera.next(kLong)) {
      EXPECT_GT(buffer->time_s, before_s);
      EXPECT_EQ(buffer->sequence, ++sequence);
      before_s = buffer->time_s;
    }
  } catch (const core::Error&) {
  }
  EXPECT_GT(sequence, 0u);
}

TEST(NetworkCamera, AnImageCutInTheMiddleIsCountedAndTheConnectionMadeAgain) {
  ScriptedHttp server(
      {[](HttpConnection& client) {
         client.begin_images();
         send_images(client, 0, 5);
         const std::vector<std::uint8_t> jpeg = recorded_jpeg(5);
         client.send("Content-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg.size()) +
                     "\r\n\r\n" + std::string(jpeg.begin(), jpeg.begin() + 100));
       },
       [](HttpConnection& client) {
         client.begin_images();
         send_images(client, 6, 5);
       }});
  NetworkCamera camera(hurried(server.address()));
  std::string fault;
  const std::vector<int> images = all_images(camera, fault);
  std::vector<int> expected = numbers_from(0, 10);
  expected.erase(expected.begin() + 5);
  EXPECT_EQ(images, expected);
  EXPECT_EQ(camera.counts().damaged, 1);
  EXPECT_EQ(camera.counts().reconnections, 1);
}

TEST(NetworkCamera, AStallIsASilenceAfterWhichItAsksAgain) {
  ScriptedHttp server({[](HttpConnection& client) {
                         client.begin_images();
                         send_images(client, 0, 5);
                         client.wait_for_end();  // a phone that went to sleep
                       },
                       [](HttpConnection& client) {
                         client.begin_images();
                         send_images(client, 5, 3);
                       }});
  NetworkCamera camera(hurried(server.address()));
  std::string fault;
  const std::vector<int> images = all_images(camera, fault);
  EXPECT_EQ(images, numbers_from(0, 7));
  EXPECT_EQ(camera.counts().reconnections, 1);
}

TEST(NetworkCamera, AServerThatNeverAnswersIsToldInTime) {
  ScriptedHttp silent({[](HttpConnection& client) { client.wait_for_end(); }});
  has(refusal(hurried(silent.address("me:secret"), 0.5)), "gives no answer");
  ScriptedHttp without_images({[](HttpConnection& client) {
    client.begin_images();
    client.wait_for_end();
  }});
  const std::string what = refusal(hurried(without_images.address(), 0.5));
  EXPECT_TRUE(what.find("no answer") != std::string::npos ||
              what.find("no more images") != std::string::npos)
      << what;
}

TEST(NetworkCamera, WhatIsNoVideoIsNamed) {
  const auto answered = [](const std::string& answer) {
    ScriptedHttp server({[&answer](HttpConnection& client) { client.send(answer); }});
    return refusal(hurried(server.address("me:secret")));
  };
  has(answered("HTTP/1.0 404 Not Found\r\nContent-Length: 0\r\n\r\n"), "nothing under this path");
  has(answered("HTTP/1.0 403 Forbidden\r\nContent-Length: 0\r\n\r\n"), "password");
  has(answered("HTTP/1.0 200 OK\r\nContent-Type: text/html\r\n\r\n<html></html>"), "text/html");
  has(answered("HTTP/1.0 200 OK\r\nContent-Type: image/jpeg\r\n\r\n\xff\xd8"), "image/jpeg");
  has(answered("HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace\r\n\r\n" +
               std::string(100000, 'x')),
      "JPEG");
  std::string noise;
  std::mt19937 random(1);
  for (int i = 0; i < 100000; ++i) noise += static_cast<char>(random());
  refusal(hurried([&] {
    static ScriptedHttp server({[noise](HttpConnection& client) { client.send(noise); }});
    return server.address();
  }()));
}

TEST(NetworkCamera, AnAddressWhereNobodyListensIsTold) {
  std::string address;
  {
    const ScriptedHttp server({});
    address = server.address("me:secret");
  }
  has(refusal(hurried(address)), "refuses the connection");
}

TEST(NetworkCamera, ImagesOfAnotherSizeEndIt) {
  ScriptedHttp server({[](HttpConnection& client) {
    client.begin_images();
    send_images(client, 0, 5);
    std::vector<std::uint8_t> turned;
    cv::imencode(".jpg", cv::Mat(64, 48, CV_8UC3, cv::Scalar::all(90)), turned);
    client.send_image(turned);
    client.send_image(turned);
    client.wait_for_end();
  }});
  NetworkCamera camera(hurried(server.address()));
  std::string fault;
  static_cast<void>(all_images(camera, fault));
  has(fault, "48x64");
}

TEST(NetworkCamera, WhatLayReadyIsDroppedButNotForLong) {
  // A server that is faster than anybody never keeps us waiting: all its images look stale, and
  // half a second of that is enough.
  ScriptedHttp server({[](HttpConnection& client) {
    client.begin_images();
    while (client.send_image(recorded_jpeg(7))) {
    }
  }});
  NetworkCameraOptions options = hurried(server.address());
  options.stale_s = 1000;
  options.answer_s = 20;
  const auto begin = std::chrono::steady_clock::now();
  NetworkCamera camera(options);
  EXPECT_TRUE(camera.next(kLong));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 500ms);
}

TEST(NetworkCamera, EndsAtOnceWhileAServerIsSilent) {
  ScriptedHttp server({[](HttpConnection& client) {
    client.begin_images();
    send_images(client, 0, 5);
    client.wait_for_end();
  }});
  NetworkCameraOptions patient = hurried(server.address());
  patient.silence_s = 1000;
  NetworkCamera camera(patient);
  EXPECT_TRUE(camera.next(kLong));
  // The end of the scope must not wait for the silence.
}

TEST(NetworkCamera, IsRecordedAsItsBytes) {
  const tests::TemporaryFolder scratch;
  ScriptedHttp server({[](HttpConnection& client) {
    client.begin_images();
    send_images(client, 0, 39);
  }});
  auto camera = std::make_unique<NetworkCamera>(hurried(server.address("me:secret")));
  SessionRecorder recorder(scratch.path() / "session", recording_setup(scratch), 30);
  CameraRecording recording(std::move(camera), recorder, {});
  const auto frames = recording.frames();
  std::vector<int> numbers;
  while (const auto frame = frames->next()) numbers.push_back(recorded_index(frame->image));
  EXPECT_EQ(numbers, numbers_from(0, 38));
  EXPECT_EQ(static_cast<int>(numbers.size()), recording.status().recorded);
  ASSERT_TRUE(recording.status().camera_fault);  // the server has gone
  for (const auto& entry : std::filesystem::directory_iterator(scratch.path() / "session")) {
    EXPECT_EQ(tests::read_file(entry.path()).find("secret"), std::string::npos) << entry.path();
  }
}

TEST(NetworkCamera, TakesWhatFfmpegServes) {
  const FfmpegServer server(2);
  if (!server.is_there()) GTEST_SKIP() << "ffmpeg is not installed";
  // It listens a moment after it has started.
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  std::unique_ptr<NetworkCamera> camera;
  while (!camera && std::chrono::steady_clock::now() < deadline) {
    try {
      NetworkCameraOptions options;
      options.address = server.address();
      options.reconnect_s = 0;
      camera = std::make_unique<NetworkCamera>(options);
    } catch (const core::Error&) {
    }
  }
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->description().width_px, 64);
  int images = 0;
  double first_s = 0, last_s = 0;
  try {
    while (const auto buffer = camera->next(kLong)) {
      if (images++ == 0) first_s = buffer->time_s;
      last_s = buffer->time_s;
    }
  } catch (const core::Error&) {
  }
  EXPECT_GE(images, 58);  // 60 but for what lay ready or stood in the last piece
  EXPECT_EQ(camera->counts().damaged, 0);
  // 30 a second, to a fifth on a busy machine.
  EXPECT_NEAR((last_s - first_s) / (images - 1), 1 / 30.0, 0.2 / 30);
}

TEST(OpenCamera, RefusesWhatANetworkCameraDoesNotTake) {
  V4l2CameraOptions wish;
  wish.device = "http://me:secret@127.0.0.1:9/video";
  wish.mode.fps = 30;
  expect_bad_input([&] { static_cast<void>(open_camera(wish)); }, "http://127.0.0.1:9/video",
                   "set them in the app");
  wish.device = "rtsp://me:secret@127.0.0.1:9/stream";
  expect_bad_input([&] { static_cast<void>(open_camera(wish)); }, "rtsp://127.0.0.1:9/stream",
                   "set them in the app");
}

TEST(ArrivalClock, SteadiesAnEvenStreamWithoutTrailingIt) {
  // 30 a second with delays of up to 60 ms, each as likely as the other.
  std::mt19937 random(4);
  std::uniform_real_distribution<double> delay(0, 0.06);
  ArrivalClock clock;
  double arrival_s = 0, last_s = -1;
  double raw = 0, steadied = 0;
  int count = 0;
  double earliest = 1, latest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double taken_s = 100 + i / 30.0;
    arrival_s = std::max(arrival_s, taken_s + delay(random));
    const double time_s = clock.time_of(arrival_s);
    EXPECT_LE(time_s, arrival_s + 1e-5);
    EXPECT_GT(time_s, last_s);
    last_s = time_s;
    if (i < 200) continue;
    ++count;
    raw += std::pow(arrival_s - taken_s - 0.03, 2);
    steadied += std::pow(time_s - taken_s, 2);
    earliest = std::min(earliest, time_s - taken_s);
    latest = std::max(latest, time_s - taken_s);
  }
  // Raw delays spread by 0.06 / sqrt(12) = 17 ms about their mean; steadied times stay within a
  // third of a frame of the moment itself.
  EXPECT_GT(std::sqrt(raw / count), 0.014);
  EXPECT_LT(std::sqrt(steadied / count), 0.011);
}

TEST(ArrivalClock, APauseIsAPause) {
  ArrivalClock clock;
  for (int i = 0; i < 100; ++i) static_cast<void>(clock.time_of(i / 30.0));
  EXPECT_DOUBLE_EQ(clock.time_of(10), 10);
}

}  // namespace
}  // namespace sheen::capture::test
