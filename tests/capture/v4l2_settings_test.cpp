// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_controls.h"
#include "capture/source/v4l2_modes.h"
#include "tests/capture/scripted_v4l2.h"

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <vector>

namespace sheen::capture {
namespace {

using test::ScriptedV4l2;

/// What a usual webcam offers: raw images slowly, JPEG fast.
std::vector<CameraMode> webcam() {
  return {{PixelFormat::yuyv, {640, 480}, 30},   {PixelFormat::yuyv, {1280, 720}, 10},
          {PixelFormat::mjpeg, {640, 480}, 30},  {PixelFormat::mjpeg, {1280, 720}, 30},
          {PixelFormat::mjpeg, {1280, 720}, 60}, {PixelFormat::mjpeg, {1920, 1080}, 30},
          {PixelFormat::nv12, {640, 480}, 30}};
}

TEST(V4l2ModeChoice, FollowsItsRuleWhateverTheOrder) {
  auto modes = webcam();
  const auto by_size = [](const CameraMode& a, const CameraMode& b) {
    return std::tuple(a.size.width_px, a.fps, a.format) <
           std::tuple(b.size.width_px, b.fps, b.format);
  };
  std::sort(modes.begin(), modes.end(), by_size);
  ModeWish raw;
  raw.format = PixelFormat::yuyv;
  ModeWish small;
  small.size = ImageSize{640, 480};
  ModeWish slow;
  slow.fps = 28;
  do {
    // 1280x720 and the largest rate; 30 is nearer to 28 than 10 and 60 are.
    EXPECT_EQ(choose_mode(modes, {}), (CameraMode{PixelFormat::mjpeg, {1280, 720}, 60}));
    EXPECT_EQ(choose_mode(modes, raw), (CameraMode{PixelFormat::yuyv, {1280, 720}, 10}));
    EXPECT_EQ(choose_mode(modes, small), (CameraMode{PixelFormat::mjpeg, {640, 480}, 30}));
    EXPECT_EQ(choose_mode(modes, slow), (CameraMode{PixelFormat::mjpeg, {1280, 720}, 30}));
  } while (std::next_permutation(modes.begin(), modes.end(), by_size));
}

TEST(V4l2ModeChoice, WhatIsAskedForIsKeptOrNothingComes) {
  ModeWish wish;
  wish.size = ImageSize{1280, 960};
  EXPECT_FALSE(choose_mode(webcam(), wish));
  wish.size.reset();
  wish.format = PixelFormat::nv12;
  EXPECT_EQ(choose_mode(webcam(), wish)->format, PixelFormat::nv12);
  EXPECT_FALSE(choose_mode({}, {}));
}

TEST(V4l2ModeChoice, WithoutTheUsualSizeTheNearestIsTaken) {
  const std::vector<CameraMode> modes{{PixelFormat::yuyv, {320, 240}, 30},
                                      {PixelFormat::yuyv, {1280, 960}, 30},
                                      {PixelFormat::yuyv, {3840, 2160}, 30}};
  EXPECT_EQ(choose_mode(modes, {})->size.height_px, 960);
}

TEST(V4l2Modes, AreWhatTheDriverLists) {
  ScriptedV4l2 system;
  system.modes = {{V4L2_PIX_FMT_MJPEG, 1280, 720, {{1, 60}, {1, 30}}},
                  {V4L2_PIX_FMT_H264, 1280, 720, {{1, 60}}},
                  {V4L2_PIX_FMT_YUYV, 640, 480, {{1001, 30000}}},
                  {V4L2_PIX_FMT_NV12, 640, 480, {{0, 30}}}};
  const V4l2Device device(system, system.node);
  const auto modes = camera_modes(device);
  // H264 cannot be read; a rate of 30/0 is no rate.
  ASSERT_EQ(modes.size(), 4u);
  EXPECT_EQ(modes[0], (CameraMode{PixelFormat::mjpeg, {1280, 720}, 60}));
  EXPECT_EQ(modes[1], (CameraMode{PixelFormat::mjpeg, {1280, 720}, 30}));
  EXPECT_NEAR(modes[2].fps, 30000. / 1001, 1e-12);
  EXPECT_EQ(modes[3], (CameraMode{PixelFormat::nv12, {640, 480}, 0}));
}

TEST(V4l2Modes, FormatsAndTheirCodesAreInverse) {
  for (const PixelFormat format : {PixelFormat::mjpeg, PixelFormat::yuyv, PixelFormat::nv12}) {
    EXPECT_EQ(pixel_format(fourcc(format)), format);
    // A fourcc is its four letters, the first in the lowest byte.
    std::string letters;
    for (int shift = 0; shift < 32; shift += 8)
      letters += static_cast<char>(fourcc(format) >> shift & 0xff);
    EXPECT_EQ(format_name(format), letters);
  }
  EXPECT_FALSE(pixel_format(V4L2_PIX_FMT_H264));
}

TEST(V4l2Modes, SettingOneIsReportedAsTheDriverDoesIt) {
  ScriptedV4l2 system;
  system.modes = {{V4L2_PIX_FMT_YUYV, 640, 480, {{1, 15}, {1, 30}}}};
  const V4l2Device device(system, system.node);
  const ActiveMode active = set_mode(device, {PixelFormat::yuyv, {640, 480}, 29});
  EXPECT_DOUBLE_EQ(active.mode.fps, 30);
  EXPECT_EQ(active.bytes_per_line, 1280);
  EXPECT_EQ(active.least_bytes, 1280u * 480u);
  EXPECT_THROW(static_cast<void>(set_mode(device, {PixelFormat::yuyv, {320, 240}, 30})), V4l2Error);
}

/// A camera with every automatic, each of them on.
std::vector<ScriptedV4l2::Control> automatic_camera() {
  return {
      {V4L2_CID_AUTO_WHITE_BALANCE, "White Balance, Automatic", 0, 1, 1, V4L2_CTRL_TYPE_BOOLEAN},
      {V4L2_CID_AUTOGAIN, "Gain, Automatic", 0, 1, 1, V4L2_CTRL_TYPE_BOOLEAN},
      {V4L2_CID_GAIN, "Gain", 0, 255, 37},
      {V4L2_CID_WHITE_BALANCE_TEMPERATURE, "White Balance Temperature", 2800, 6500, 4600},
      {V4L2_CID_EXPOSURE_AUTO, "Auto Exposure", 0, 3, 3, V4L2_CTRL_TYPE_MENU},
      {V4L2_CID_EXPOSURE_ABSOLUTE, "Exposure Time, Absolute", 3, 2047, 156},
      {V4L2_CID_EXPOSURE_AUTO_PRIORITY, "Exposure, Dynamic Framerate", 0, 1, 1,
       V4L2_CTRL_TYPE_BOOLEAN},
      {V4L2_CID_FOCUS_ABSOLUTE, "Focus, Absolute", 0, 250, 30},
      {V4L2_CID_FOCUS_AUTO, "Focus, Automatic Continuous", 0, 1, 1, V4L2_CTRL_TYPE_BOOLEAN}};
}

TEST(V4l2Controls, LockingStopsEveryAutomaticWhereItIs) {
  ScriptedV4l2 system;
  system.controls = automatic_camera();
  const V4l2Device device(system, system.node);
  hold_frame_rate(device);
  const auto locked = lock_automatics(device);
  EXPECT_EQ(locked.size(), 8u);
  EXPECT_EQ(system.value_of(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(system.value_of(V4L2_CID_AUTOGAIN), 0);
  EXPECT_EQ(system.value_of(V4L2_CID_AUTO_WHITE_BALANCE), 0);
  EXPECT_EQ(system.value_of(V4L2_CID_FOCUS_AUTO), 0);
  EXPECT_EQ(system.value_of(V4L2_CID_EXPOSURE_AUTO_PRIORITY), 0);
  EXPECT_EQ(system.value_of(V4L2_CID_EXPOSURE_ABSOLUTE), 156);
  EXPECT_EQ(system.value_of(V4L2_CID_GAIN), 37);
  EXPECT_EQ(system.value_of(V4L2_CID_WHITE_BALANCE_TEMPERATURE), 4600);
  EXPECT_EQ(system.value_of(V4L2_CID_FOCUS_ABSOLUTE), 30);
  // Locking what is locked changes nothing.
  EXPECT_EQ(lock_automatics(device), locked);
}

TEST(V4l2Controls, ACameraThatRefusesIsLeftAsItIs) {
  ScriptedV4l2 system;
  system.controls = automatic_camera();
  const V4l2Device device(system, system.node);
  system.fail(VIDIOC_S_CTRL, EIO, 1000);
  EXPECT_TRUE(lock_automatics(device).empty());
  ScriptedV4l2 bare;
  EXPECT_TRUE(lock_automatics(V4l2Device(bare, bare.node)).empty());
}

TEST(V4l2Controls, AreSetByTheirName) {
  ScriptedV4l2 system;
  system.controls = automatic_camera();
  const V4l2Device device(system, system.node);
  set_controls(device, {{"focus_automatic_continuous", 0}, {"focus_absolute", 77}});
  EXPECT_EQ(system.value_of(V4L2_CID_FOCUS_AUTO), 0);
  EXPECT_EQ(system.value_of(V4L2_CID_FOCUS_ABSOLUTE), 77);
}

TEST(V4l2Controls, NamesAndValuesThatDoNotExistAreRefusedWithThoseThatDo) {
  ScriptedV4l2 system;
  system.controls = {{V4L2_CID_GAIN, "Gain", 10, 255, 37}};
  const V4l2Device device(system, system.node);
  const auto refusal = [&](const ControlValue& value) -> std::string {
    try {
      set_controls(device, {value});
    } catch (const core::Error& error) {
      EXPECT_EQ(error.kind(), core::Error::Kind::bad_input);
      return error.what();
    }
    return {};
  };
  EXPECT_NE(refusal({"shutter", 1}).find("gain"), std::string::npos);
  EXPECT_NE(refusal({"gain", 9}).find("from 10 to 255"), std::string::npos);
  EXPECT_NE(refusal({"gain", 256}).find("from 10 to 255"), std::string::npos);
  EXPECT_EQ(system.value_of(V4L2_CID_GAIN), 37);
}

TEST(V4l2Controls, AnEndlessListEnds) {
  /// Answers every question for the next control with the same one.
  class Parrot : public ScriptedV4l2 {
   public:
    int ioctl(int descriptor, unsigned long request, void* argument) override {
      if (request != VIDIOC_QUERYCTRL) return ScriptedV4l2::ioctl(descriptor, request, argument);
      auto& entry = *static_cast<v4l2_queryctrl*>(argument);
      entry = {};
      entry.id = V4L2_CID_GAIN;
      entry.type = V4L2_CTRL_TYPE_INTEGER;
      return 0;
    }
  };
  Parrot system;
  EXPECT_LE(camera_controls(V4l2Device(system, system.node)).size(), 1024u);
}

}  // namespace
}  // namespace sheen::capture
