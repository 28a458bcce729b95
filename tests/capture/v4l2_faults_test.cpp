// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_camera.h"
#include "capture/source/v4l2_listing.h"
#include "tests/capture/scripted_v4l2.h"

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

namespace sheen::capture {
namespace {

using namespace std::chrono_literals;
using core::Error;
using test::at_once;
using test::image_count;
using test::ScriptedV4l2;

/// Numbers of the images that came while `rounds` times 100 ms passed.
std::vector<std::uint32_t> sequences(V4l2Camera& camera, int rounds) {
  std::vector<std::uint32_t> found;
  for (int round = 0; round < rounds; ++round)
    if (const auto buffer = camera.next(100ms)) found.push_back(buffer->sequence);
  return found;
}

void expect_no_gap(const std::vector<std::uint32_t>& numbers) {
  for (std::size_t n = 0; n < numbers.size(); ++n) EXPECT_EQ(numbers[n], n);
}

/// One way in which a stream breaks at its tenth image.
struct Break {
  const char* name;
  void (*happen)(ScriptedV4l2&);
};
void PrintTo(const Break& fault, std::ostream* out) {
  *out << fault.name;
}

class V4l2BrokenStream : public testing::TestWithParam<Break> {};

TEST_P(V4l2BrokenStream, IsStartedAgainAndNumberedOn) {
  ScriptedV4l2 system;
  system.events[10] = [&] { GetParam().happen(system); };
  V4l2Camera camera(system, at_once());
  const auto numbers = sequences(camera, 60);
  ASSERT_GT(numbers.size(), 40u);
  expect_no_gap(numbers);
  EXPECT_EQ(camera.counts().reconnections, 1);
  EXPECT_EQ(system.starts, 2);
  EXPECT_EQ(system.violations, 0);
  EXPECT_EQ(system.open_descriptors(), 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Faults, V4l2BrokenStream,
    testing::Values(
        Break{"DQBUF EIO", [](ScriptedV4l2& system) { system.fail(VIDIOC_DQBUF, EIO); }},
        Break{"DQBUF EPIPE", [](ScriptedV4l2& system) { system.fail(VIDIOC_DQBUF, EPIPE); }},
        Break{"DQBUF ENODEV", [](ScriptedV4l2& system) { system.fail(VIDIOC_DQBUF, ENODEV); }},
        Break{"QBUF EINVAL", [](ScriptedV4l2& system) { system.fail(VIDIOC_QBUF, EINVAL); }},
        Break{"poll ENOMEM", [](ScriptedV4l2& system) { system.fail_poll(ENOMEM); }},
        Break{"not streaming any more",
              [](ScriptedV4l2& system) {
                int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
                system.ioctl(100, VIDIOC_STREAMOFF, &type);
              }},
        Break{"fault while it starts again", [](ScriptedV4l2& system) {
                system.fail(VIDIOC_DQBUF, EIO);
                system.fail(VIDIOC_STREAMON, EINVAL, 2);
                system.fail(VIDIOC_REQBUFS, EBUSY, 2);
              }}));

TEST(V4l2Unplugged, ComesBackWithTheSameModeControlsAndNumbers) {
  ScriptedV4l2 system;
  system.controls = {{V4L2_CID_AUTOGAIN, "Gain, Automatic", 0, 1, 1, V4L2_CTRL_TYPE_BOOLEAN},
                     {V4L2_CID_GAIN, "Gain", 0, 255, 37},
                     {V4L2_CID_CONTRAST, "Contrast", 0, 10, 5}};
  V4l2CameraOptions options;
  options.controls = {{"contrast", 8}};
  options.mode.fps = 25;
  V4l2Camera camera(system, options);
  const auto before = sequences(camera, 5);

  system.unplug();
  EXPECT_TRUE(sequences(camera, 30).empty());
  EXPECT_EQ(system.open_descriptors(), 0u);
  system.plug_in();
  ASSERT_EQ(system.value_of(V4L2_CID_AUTOGAIN), 1);

  auto numbers = before;
  for (const std::uint32_t number : sequences(camera, 10)) numbers.push_back(number);
  EXPECT_GE(numbers.size(), 10u);
  expect_no_gap(numbers);
  EXPECT_EQ(camera.counts().reconnections, 1);
  EXPECT_EQ(camera.counts().lost, 0);
  EXPECT_EQ(system.value_of(V4L2_CID_AUTOGAIN), 0);
  EXPECT_EQ(system.value_of(V4L2_CID_GAIN), 37);
  EXPECT_EQ(system.value_of(V4L2_CID_CONTRAST), 8);
  EXPECT_DOUBLE_EQ(system.fps(), 25);
  EXPECT_EQ(system.violations, 0);
}

TEST(V4l2Unplugged, IsFoundUnderAnotherNumber) {
  ScriptedV4l2 system;
  V4l2Camera camera(system, at_once());
  sequences(camera, 3);
  system.unplug();
  sequences(camera, 3);
  system.node = "/dev/video2";
  system.plug_in();
  EXPECT_FALSE(sequences(camera, 10).empty());
}

TEST(V4l2Unplugged, AnotherCameraInItsPlaceIsNotTaken) {
  ScriptedV4l2 system;
  V4l2Camera camera(system, at_once());
  sequences(camera, 3);
  system.unplug();
  system.name = "Another Camera";
  system.plug_in();
  EXPECT_TRUE(sequences(camera, 20).empty());
  EXPECT_EQ(system.open_descriptors(), 0u);
}

TEST(V4l2Unplugged, GivesUpWithOneClearLine) {
  ScriptedV4l2 system;
  V4l2CameraOptions options = at_once();
  options.reconnect_s = 7;
  V4l2Camera camera(system, options);
  sequences(camera, 3);
  system.unplug();
  const auto unplugged = system.now();
  try {
    sequences(camera, 1000);
    FAIL() << "waits for ever";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::run_failed);
    const std::string line = error.what();
    EXPECT_NE(line.find("/dev/video0"), std::string::npos) << line;
    EXPECT_NE(line.find("7 s"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
  // Patience is looked at whenever a wait ends: at the latest one interval of attempts after.
  EXPECT_GE(system.now() - unplugged, 7s);
  EXPECT_LE(system.now() - unplugged, 7s + 200ms);
  EXPECT_EQ(system.open_descriptors(), 0u);
  EXPECT_EQ(system.violations, 0);
}

TEST(V4l2Silence, StartsTheStreamAgain) {
  ScriptedV4l2 system;
  V4l2Camera camera(system, at_once());
  sequences(camera, 3);
  system.silent = true;
  // 5 s of silence are 50 waits of 100 ms.
  EXPECT_TRUE(sequences(camera, 49).empty());
  EXPECT_EQ(system.starts, 1);
  sequences(camera, 3);
  EXPECT_EQ(system.starts, 2);
  system.silent = false;
  EXPECT_FALSE(sequences(camera, 5).empty());
  EXPECT_EQ(camera.counts().reconnections, 1);
}

TEST(V4l2Silence, EndsInAnError) {
  ScriptedV4l2 system;
  V4l2Camera camera(system, at_once());
  system.silent = true;
  const auto before = system.now();
  EXPECT_THROW(sequences(camera, 10000), V4l2Error);
  // 5 s until the first suspicion, 30 s of patience, at most one more silence to notice.
  EXPECT_GE(system.now() - before, 35s);
  EXPECT_LE(system.now() - before, 40s);
}

TEST(V4l2Silence, AStreamThatBreaksAgainAndAgainIsGivenUp) {
  ScriptedV4l2 system;
  V4l2Camera camera(system, at_once());
  sequences(camera, 3);
  system.fail(VIDIOC_DQBUF, EIO, 1000000);
  const auto before = system.now();
  EXPECT_THROW(sequences(camera, 10000), V4l2Error);
  EXPECT_GE(system.now() - before, 30s);
  EXPECT_LE(system.now() - before, 31s);
  EXPECT_EQ(system.violations, 0);
}

class V4l2Start : public testing::TestWithParam<std::tuple<unsigned long, int, const char*>> {};

TEST_P(V4l2Start, AFaultIsOneLineAndLeavesNothingOpen) {
  const auto [request, code, word] = GetParam();
  ScriptedV4l2 system;
  system.fail(request, code);
  try {
    V4l2Camera camera(system, at_once());
    FAIL() << "starts all the same";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::run_failed);
    const std::string line = error.what();
    EXPECT_TRUE(line.starts_with("/dev/video0: ")) << line;
    EXPECT_NE(line.find(word), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
  EXPECT_EQ(system.open_descriptors(), 0u);
  EXPECT_EQ(system.mapped(), 0u);
  EXPECT_EQ(system.violations, 0);
}

INSTANTIATE_TEST_SUITE_P(Requests, V4l2Start,
                         testing::Values(std::tuple(VIDIOC_QUERYCAP, EIO, "what it can do"),
                                         std::tuple(VIDIOC_S_FMT, EBUSY, "close the program"),
                                         std::tuple(VIDIOC_REQBUFS, EINVAL, "memory"),
                                         std::tuple(VIDIOC_QUERYBUF, EINVAL, "memory"),
                                         std::tuple(VIDIOC_QBUF, EINVAL, "memory"),
                                         std::tuple(VIDIOC_STREAMON, ENOSPC,
                                                    "starting the stream")));

TEST(V4l2StartRefused, WhatIsNoCameraIsBadInput) {
  const auto kind_of = [](ScriptedV4l2& system, const V4l2CameraOptions& options) {
    try {
      V4l2Camera camera(system, options);
    } catch (const Error& error) {
      EXPECT_EQ(system.open_descriptors(), 0u);
      return error.kind();
    }
    ADD_FAILURE() << "starts";
    return Error::Kind::run_failed;
  };
  V4l2CameraOptions elsewhere = at_once();
  elsewhere.device = "/dev/video7";
  ScriptedV4l2 absent;
  EXPECT_EQ(kind_of(absent, elsewhere), Error::Kind::bad_input);
  ScriptedV4l2 output;
  output.abilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
  EXPECT_EQ(kind_of(output, at_once()), Error::Kind::bad_input);
  ScriptedV4l2 unknown_format;
  unknown_format.modes = {{V4L2_PIX_FMT_H264, 64, 48, {{1, 30}}}};
  EXPECT_EQ(kind_of(unknown_format, at_once()), Error::Kind::bad_input);
  ScriptedV4l2 other_size;
  V4l2CameraOptions large = at_once();
  large.mode.size = ImageSize{4096, 2160};
  EXPECT_EQ(kind_of(other_size, large), Error::Kind::bad_input);
  ScriptedV4l2 no_such_control;
  V4l2CameraOptions shutter = at_once();
  shutter.controls = {{"shutter", 1}};
  EXPECT_EQ(kind_of(no_such_control, shutter), Error::Kind::bad_input);
}

TEST(V4l2StartRefused, InterlacedImagesAreRefused) {
  ScriptedV4l2 system;
  system.field = V4L2_FIELD_INTERLACED;
  EXPECT_THROW(V4l2Camera(system, at_once()), V4l2Error);
  EXPECT_EQ(system.open_descriptors(), 0u);
}

TEST(V4l2StartRefused, ADriverWithoutMemoryForTwoImagesIsRefused) {
  ScriptedV4l2 system;
  system.driver_buffers = 1;
  EXPECT_THROW(V4l2Camera(system, at_once()), V4l2Error);
  EXPECT_EQ(system.open_descriptors(), 0u);
  EXPECT_EQ(system.mapped(), 0u);
}

TEST(V4l2Kernel, FilesAndOtherDevicesAreNoCameras) {
  for (const char* path : {"/dev/null", "/nonexistent/video0"}) try {
      const V4l2Device device(kernel_v4l2_system(), path);
      ADD_FAILURE() << path << " opens as a camera";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::bad_input) << error.what();
    }
}

TEST(V4l2Listing, ShowsCamerasAndOnlyThem) {
  ScriptedV4l2 system;
  system.controls = {{V4L2_CID_GAIN, "Gain", 0, 255, 37}};
  const auto cameras = list_cameras(system);
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_EQ(cameras[0].device, "/dev/video0");
  EXPECT_EQ(cameras[0].name, "Scripted Camera");
  EXPECT_EQ(cameras[0].modes.size(), 2u);
  ASSERT_EQ(cameras[0].controls.size(), 1u);
  EXPECT_EQ(cameras[0].controls[0].value, 37);
  EXPECT_TRUE(cameras[0].fault.empty());

  system.abilities = V4L2_CAP_VIDEO_OUTPUT;
  EXPECT_TRUE(list_cameras(system).empty());

  system.fail(VIDIOC_QUERYCAP, EIO);
  const auto broken = list_cameras(system);
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_FALSE(broken[0].fault.empty());
  EXPECT_EQ(system.open_descriptors(), 0u);
}

}  // namespace
}  // namespace sheen::capture
