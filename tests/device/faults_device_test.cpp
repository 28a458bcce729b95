// SPDX-License-Identifier: MIT
#include "tests/device/rig.h"

#include <chrono>
#include <string>

namespace sheen::capture {
namespace {

using namespace test;
using core::Error;

using DeviceFaults = RigTest;

TEST_F(DeviceFaults, DroppedBuffersAreCounted) {
  V4l2Camera camera(kernel_v4l2_system(), quick());
  set_control(converter_node, "percentage_of_dropped_buffers", 30);
  const auto images = take(camera, 200);
  set_control(converter_node, "percentage_of_dropped_buffers", 0);
  ASSERT_EQ(images.size(), 200u);
  expect_times_grow(images);
  // Every number that is missing is counted, and nothing else.
  const auto numbers = images.back().sequence - images.front().sequence + 1;
  EXPECT_EQ(camera.counts().lost, static_cast<int>(numbers - 200));
  // Each is dropped with probability .3: 200 / .7 - 200 = 86 lost, standard deviation 11.
  EXPECT_GT(camera.counts().lost, 86 - 5 * 11);
  EXPECT_LT(camera.counts().lost, 86 + 5 * 11);
  EXPECT_EQ(camera.counts().reconnections, 0);
}

TEST_F(DeviceFaults, AFlaggedBufferIsSkippedAndCounted) {
  V4l2Camera camera(kernel_v4l2_system(), quick());
  auto images = take(camera, 20);
  press(converter_node, "inject_v4l2_buf_flag_error");
  for (const Taken& image : take(camera, 40)) images.push_back(image);
  ASSERT_EQ(images.size(), 60u);
  EXPECT_EQ(camera.counts().damaged, 1);
  EXPECT_EQ(camera.counts().lost, 0);
  EXPECT_EQ(camera.counts().reconnections, 0);
  // One number is missing: that of the damaged image.
  EXPECT_EQ(images.back().sequence - images.front().sequence, 60u);
}

/// A fault in mid-stream after which the camera goes on with the next number.
void expect_goes_on_after(const std::string& control) {
  V4l2Camera camera(kernel_v4l2_system(), quick());
  auto images = take(camera, 20);
  press(converter_node, control);
  for (const Taken& image : take(camera, 60)) images.push_back(image);
  ASSERT_EQ(images.size(), 80u);
  expect_numbered_without_gap(images);
  expect_times_grow(images);
  EXPECT_EQ(camera.counts().reconnections, 1);
}

TEST_F(DeviceFaults, AQueueErrorStartsTheStreamAgain) {
  expect_goes_on_after("inject_vidioc_qbuf_error");
}

TEST_F(DeviceFaults, AFatalStreamingErrorStartsTheStreamAgain) {
  expect_goes_on_after("inject_fatal_streaming_error");
}

TEST_F(DeviceFaults, ADisconnectedCameraIsOpenedAgain) {
  expect_goes_on_after("disconnect");
}

/// A fault at the start is one clear line, and the next start works.
void expect_refused_once(const std::string& control) {
  press(converter_node, control);
  try {
    V4l2Camera camera(kernel_v4l2_system(), quick());
    ADD_FAILURE() << "starts all the same";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::run_failed);
    EXPECT_TRUE(std::string(error.what()).starts_with(converter_node)) << error.what();
  }
  V4l2Camera camera(kernel_v4l2_system(), quick());
  EXPECT_EQ(take(camera, 10).size(), 10u);
}

TEST_F(DeviceFaults, AReservationErrorAtTheStartIsOneLine) {
  expect_refused_once("inject_vidioc_reqbufs_error");
}

TEST_F(DeviceFaults, AStreamOnErrorAtTheStartIsOneLine) {
  expect_refused_once("inject_vidioc_streamon_error");
}

TEST_F(DeviceFaults, AStreamOnErrorWhileItStartsAgainIsGotOver) {
  V4l2Camera camera(kernel_v4l2_system(), quick());
  auto images = take(camera, 20);
  press(converter_node, "inject_vidioc_streamon_error");
  press(converter_node, "inject_fatal_streaming_error");
  for (const Taken& image : take(camera, 60)) images.push_back(image);
  ASSERT_EQ(images.size(), 80u);
  expect_numbered_without_gap(images);
  EXPECT_EQ(camera.counts().reconnections, 1);
}

TEST_F(DeviceFaults, ACountThatRunsOverIsNoLoss) {
  // vivid then starts 128 before the end of its count.
  set_control(converter_node, "wrap_sequence_number", 1);
  V4l2Camera camera(kernel_v4l2_system(), quick());
  const auto images = take(camera, 200);
  set_control(converter_node, "wrap_sequence_number", 0);
  ASSERT_EQ(images.size(), 200u);
  expect_numbered_without_gap(images);
  EXPECT_EQ(camera.counts().lost, 0);
}

TEST_F(DeviceFaults, AClockThatRunsOverIsReplaced) {
  // vivid then stamps images as if the machine had run for 2^63 ns or 2^31 s all but a moment.
  for (const int kind : {1, 2}) {
    set_control(converter_node, "wrap_timestamp", kind);
    V4l2Camera camera(kernel_v4l2_system(), quick());
    const auto images = take(camera, 200);
    ASSERT_EQ(images.size(), 200u);
    expect_times_grow(images);
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    EXPECT_LE(images.back().time_s, std::chrono::duration<double>(now).count());
    EXPECT_GT(images.front().time_s, 0);
  }
  set_control(converter_node, "wrap_timestamp", 0);
}

TEST_F(DeviceFaults, ACameraInUseIsRefusedWithTheReason) {
  V4l2Camera camera(kernel_v4l2_system(), quick());
  try {
    V4l2Camera second(kernel_v4l2_system(), quick());
    ADD_FAILURE() << "two programs stream from one camera";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("close the program that uses it"), std::string::npos)
        << error.what();
  }
  EXPECT_EQ(take(camera, 20).size(), 20u);
}

TEST_F(DeviceFaults, AnUnpluggedCameraGoesOnWhenItIsBack) {
  V4l2Camera camera(kernel_v4l2_system(), quick());
  auto images = take(camera, 20);
  unbind_vivid();
  // Away for 3 s, of which nothing comes.
  for (int wait = 0; wait < 30; ++wait) EXPECT_FALSE(camera.next(std::chrono::milliseconds(100)));
  bind_vivid();
  for (const Taken& image : take(camera, 60)) images.push_back(image);
  ASSERT_EQ(images.size(), 80u);
  expect_numbered_without_gap(images);
  EXPECT_GT(images[20].time_s - images[19].time_s, 3);
  EXPECT_EQ(camera.counts().reconnections, 1);
}

TEST_F(DeviceFaults, AnUnpluggedCameraThatStaysAwayIsGivenUp) {
  V4l2CameraOptions options = quick();
  options.reconnect_s = 3;
  {
    V4l2Camera camera(kernel_v4l2_system(), options);
    ASSERT_EQ(take(camera, 20).size(), 20u);
    unbind_vivid();
    EXPECT_THROW(take(camera, 1), V4l2Error);
  }
  bind_vivid();
  V4l2Camera again(kernel_v4l2_system(), quick());
  EXPECT_EQ(take(again, 10).size(), 10u);
}

}  // namespace
}  // namespace sheen::capture
