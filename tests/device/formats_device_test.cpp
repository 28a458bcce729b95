// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_listing.h"
#include "tests/device/loopback_player.h"
#include "tests/device/rig.h"

#include <algorithm>
#include <chrono>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace sheen::capture {
namespace {

using namespace test;
using namespace std::chrono_literals;

class DeviceFormats : public RigTest,
                      public testing::WithParamInterface<std::tuple<PixelFormat, ImageSize>> {};

/// Y of every pixel and the mean of U and V.
struct Luma {
  std::vector<int> y;
  double mean_uv = 0;
};

Luma luma(const CameraBuffer& buffer) {
  Luma found;
  double uv = 0;
  std::size_t uv_count = 0;
  const auto line = static_cast<std::size_t>(buffer.bytes_per_line);
  const auto height = static_cast<std::size_t>(buffer.height_px);
  const auto width = static_cast<std::size_t>(buffer.width_px);
  const bool packed = buffer.format == PixelFormat::yuyv;
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t column = 0; column < width; ++column) {
      found.y.push_back(buffer.bytes[row * line + (packed ? 2 * column : column)]);
      if (!packed && row % 2 == 1) continue;
      uv += buffer.bytes[packed ? row * line + 2 * column + 1
                                : height * line + row / 2 * line + column];
      ++uv_count;
    }
  found.mean_uv = uv / static_cast<double>(uv_count);
  return found;
}

TEST_P(DeviceFormats, AWhiteWallIsWhite) {
  const auto [format, size] = GetParam();
  V4l2CameraOptions options = quick();
  options.mode.format = format;
  options.mode.size = size;
  // Pattern 6 of vivid is "100% White"; mode 2 of its text is "None".
  options.controls = {{"test_pattern", 6}, {"osd_text_mode", 2}};
  V4l2Camera camera(kernel_v4l2_system(), options);
  const auto buffer = camera.next(1000ms);
  ASSERT_TRUE(buffer);
  EXPECT_EQ(buffer->format, format);
  EXPECT_EQ(buffer->width_px, size.width_px);
  EXPECT_EQ(buffer->height_px, size.height_px);
  const Luma white = luma(*buffer);
  // ITU-R BT.601, limited range: white is Y = 235, U = V = 128; the scaler may round.
  EXPECT_NEAR(*std::min_element(white.y.begin(), white.y.end()), 235, 2);
  EXPECT_NEAR(*std::max_element(white.y.begin(), white.y.end()), 235, 2);
  EXPECT_NEAR(white.mean_uv, 128, 1);
  set_control(converter_node, "test_pattern", 0);
}

/// For the table that scripts/test-v4l2 prints: "YUYV_640x480".
std::string mode_name(const testing::TestParamInfo<std::tuple<PixelFormat, ImageSize>>& info) {
  const auto& [format, size] = info.param;
  return format_name(format) + "_" + std::to_string(size.width_px) + "x" +
         std::to_string(size.height_px);
}

const auto raw_modes = testing::Combine(
    testing::Values(PixelFormat::yuyv, PixelFormat::nv12),
    testing::Values(ImageSize{640, 480}, ImageSize{1280, 720}, ImageSize{1920, 1080}));

INSTANTIATE_TEST_SUITE_P(Vivid, DeviceFormats, raw_modes, mode_name);

using DeviceModes = RigTest;

TEST_F(DeviceModes, TheListOfCamerasShowsBothFormatsAndTheirRates) {
  const auto cameras = list_cameras(kernel_v4l2_system());
  const auto webcam = std::find_if(cameras.begin(), cameras.end(), [](const CameraListing& camera) {
    return camera.device == webcam_node;
  });
  ASSERT_NE(webcam, cameras.end());
  EXPECT_TRUE(webcam->fault.empty()) << webcam->fault;
  // vivid's webcam has 6 sizes; from the largest with 2 rates each has 2 more, so
  // 2 + 4 + ... + 12 = 42 modes for each of YUYV and NV12.
  EXPECT_EQ(webcam->modes.size(), 84u);
  const bool has_gain =
      std::any_of(webcam->controls.begin(), webcam->controls.end(),
                  [](const CameraControl& control) { return control.name == "gain"; });
  EXPECT_TRUE(has_gain);
}

TEST_F(DeviceModes, TheLoopbackIsNoCameraUntilSomebodyPlays) {
  EXPECT_THROW(V4l2Camera(kernel_v4l2_system(), quick(loopback_node)), V4l2Error);
}

TEST_F(DeviceModes, TheWishedRateIsSet) {
  for (const double fps : {10., 25., 40.}) {
    V4l2CameraOptions options = quick(webcam_node);
    options.mode.size = ImageSize{640, 360};
    options.mode.fps = fps;
    V4l2Camera camera(kernel_v4l2_system(), options);
    EXPECT_DOUBLE_EQ(camera.description().fps, fps);
    const auto images = take(camera, 11);
    ASSERT_EQ(images.size(), 11u);
    // Ten periods; vivid wakes at ticks of 1 ms.
    EXPECT_NEAR(images.back().time_s - images.front().time_s, 10 / fps, 2e-3);
  }
}

class DeviceRate : public RigTest,
                   public testing::WithParamInterface<std::tuple<PixelFormat, ImageSize>> {};

TEST_P(DeviceRate, SixtyImagesASecondWithoutAGap) {
  const auto [format, size] = GetParam();
  V4l2CameraOptions options = quick();
  options.mode.format = format;
  options.mode.size = size;
  V4l2Camera camera(kernel_v4l2_system(), options);
  EXPECT_NEAR(camera.description().fps, 60, .1);
  const auto images = take(camera, 301);
  ASSERT_EQ(images.size(), 301u);
  expect_numbered_without_gap(images);
  expect_times_grow(images);
  EXPECT_EQ(camera.counts().lost, 0);
  // 300 periods of 1/60 s; vivid wakes at ticks of 1 ms.
  EXPECT_NEAR(images.back().time_s - images.front().time_s, 5, .01);
}

INSTANTIATE_TEST_SUITE_P(Vivid, DeviceRate, raw_modes, mode_name);

using DeviceControls = RigTest;

TEST_F(DeviceControls, TheAutomaticGainStopsWhereItIs) {
  // vivid's automatic gain moves once a second.
  V4l2CameraOptions options = quick();
  options.lock_automatics = true;
  V4l2Camera camera(kernel_v4l2_system(), options);
  const auto value_of = [](const std::string& name) {
    for (const auto& control : camera_controls(V4l2Device(kernel_v4l2_system(), converter_node)))
      if (control.name == name) return control.value;
    return -1;
  };
  EXPECT_EQ(value_of("gain_automatic"), 0);
  const int gain = value_of("gain");
  const bool is_told = std::find(camera.locked().begin(), camera.locked().end(),
                                 ControlValue{"gain", gain}) != camera.locked().end();
  EXPECT_TRUE(is_told);
  ASSERT_EQ(take(camera, 150).size(), 150u);
  EXPECT_EQ(value_of("gain"), gain);
  set_control(converter_node, "gain_automatic", 1);
}

using DeviceLoopback = RigTest;

/// What the camera delivers is the recording, round and round, without a gap or a changed bit.
void expect_bit_exact(const Recording& recording, std::size_t rounds) {
  const LoopbackPlayer player(loopback_node, recording);
  V4l2CameraOptions options;
  options.device = loopback_node;
  options.lock_automatics = false;
  V4l2Camera camera(kernel_v4l2_system(), options);
  EXPECT_EQ(camera.description().format, recording.format);
  EXPECT_EQ(camera.description().width_px, recording.size.width_px);
  EXPECT_NEAR(camera.description().fps, recording.fps, 1e-9);

  const std::size_t count = recording.images.size();
  std::size_t at = count;
  std::size_t exact = 0;
  for (std::size_t n = 0; n < rounds * count; ++n) {
    const auto buffer = camera.next(2000ms);
    ASSERT_TRUE(buffer);
    const auto same = [&](const std::vector<std::uint8_t>& image) {
      return std::equal(image.begin(), image.end(), buffer->bytes.begin(), buffer->bytes.end());
    };
    // The first image tells where in the recording the player is.
    const auto& all = recording.images;
    if (n == 0)
      at = static_cast<std::size_t>(std::find_if(all.begin(), all.end(), same) - all.begin());
    ASSERT_LT(at, count) << "the first image is none of the recording";
    if (same(all[(at + n) % count])) ++exact;
  }
  EXPECT_EQ(exact, rounds * count);
  EXPECT_EQ(camera.counts().lost, 0);
  EXPECT_EQ(camera.counts().damaged, 0);
}

TEST_F(DeviceLoopback, ARecordedSessionArrivesBitExact) {
  expect_bit_exact(sample_recording(), 2);
}

TEST_F(DeviceLoopback, RawImagesAtSixtyASecondArriveBitExact) {
  Recording recording;
  recording.format = PixelFormat::yuyv;
  recording.size = {640, 480};
  recording.fps = 60;
  std::mt19937 random(5);
  for (int n = 0; n < 8; ++n) {
    std::vector<std::uint8_t> image(640 * 480 * 2);
    std::generate(image.begin(), image.end(), [&] { return static_cast<std::uint8_t>(random()); });
    recording.images.push_back(std::move(image));
  }
  expect_bit_exact(recording, 30);
}

}  // namespace
}  // namespace sheen::capture
