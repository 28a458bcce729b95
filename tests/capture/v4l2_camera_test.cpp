// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_camera.h"

#include "tests/capture/scripted_v4l2.h"

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cerrno>
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

struct Taken {
  std::uint32_t count;
  std::uint32_t sequence;
  double time_s;
};

Taken taken(const CameraBuffer& buffer) {
  return {image_count(buffer.bytes.data(), buffer.format == PixelFormat::mjpeg), buffer.sequence,
          buffer.time_s};
}

std::vector<Taken> take(V4l2Camera& camera, std::size_t wanted) {
  std::vector<Taken> images;
  // A camera that never answers must fail a test, not hang it.
  for (int attempt = 0; attempt < 1000 && images.size() < wanted; ++attempt)
    if (const auto buffer = camera.next(100ms)) images.push_back(taken(*buffer));
  return images;
}

TEST(V4l2Camera, DeliversEveryImageButTheFirstOnceAndInOrder) {
  ScriptedV4l2 system;
  V4l2Camera camera(system, at_once());
  const double start_s = std::chrono::duration<double>(system.now()).count();
  const auto images = take(camera, 200);
  ASSERT_EQ(images.size(), 200u);
  for (std::uint32_t n = 0; n < 200; ++n) {
    // Image 0 may be stale and is dropped; numbers start at 0 and go with the driver's.
    EXPECT_EQ(images[n].count, n + 1);
    EXPECT_EQ(images[n].sequence, n);
    // Image k is exposed k + 1 periods of 20 ms after the start; stamps have microseconds.
    EXPECT_NEAR(images[n].time_s, start_s + .02 * (n + 2), 1e-6);
  }
  EXPECT_EQ(camera.counts().lost, 0);
  EXPECT_EQ(camera.counts().damaged, 0);
  EXPECT_EQ(system.violations, 0);
}

TEST(V4l2Camera, GivesEverythingBackToTheKernel) {
  ScriptedV4l2 system;
  {
    V4l2Camera camera(system, at_once());
    take(camera, 20);
    EXPECT_EQ(system.open_descriptors(), 1u);
    EXPECT_EQ(system.mapped(), 8u);
  }
  EXPECT_EQ(system.open_descriptors(), 0u);
  EXPECT_EQ(system.mapped(), 0u);
  EXPECT_EQ(system.violations, 0);
}

class V4l2Format : public testing::TestWithParam<std::tuple<std::uint32_t, std::size_t, int>> {};

TEST_P(V4l2Format, ArrivesWithItsBytesAndItsLines) {
  const auto [code, bytes, bytes_per_line] = GetParam();
  ScriptedV4l2 system;
  system.modes = {{code, 64, 48, {{1, 50}}}};
  V4l2Camera camera(system, at_once());
  const auto buffer = camera.next(100ms);
  ASSERT_TRUE(buffer);
  EXPECT_EQ(fourcc(buffer->format), code);
  EXPECT_EQ(buffer->bytes.size(), bytes);
  EXPECT_EQ(buffer->bytes_per_line, bytes_per_line);
  EXPECT_EQ(buffer->width_px, 64);
  EXPECT_EQ(buffer->height_px, 48);
  EXPECT_EQ(camera.description().format, buffer->format);
  EXPECT_DOUBLE_EQ(camera.description().fps, 50);
  EXPECT_EQ(camera.description().name, "Scripted Camera");
}

// 64x48: YUYV has two bytes a pixel, NV12 one and a half; the script's JPEG has 200 bytes.
INSTANTIATE_TEST_SUITE_P(All, V4l2Format,
                         testing::Values(std::tuple(V4L2_PIX_FMT_YUYV, 6144u, 128),
                                         std::tuple(V4L2_PIX_FMT_NV12, 4608u, 64),
                                         std::tuple(V4L2_PIX_FMT_MJPEG, 200u, 0)));

TEST(V4l2Camera, SaysNothingWithinTheTimeAsked) {
  ScriptedV4l2 system;
  V4l2Camera camera(system, at_once());
  system.silent = true;
  const auto before = system.now();
  EXPECT_FALSE(camera.next(70ms));
  EXPECT_EQ(system.now() - before, 70ms);
}

TEST(V4l2Camera, CountsImagesThatTheDriverLost) {
  ScriptedV4l2 system;
  system.spoil = [](ScriptedV4l2::Image& image) {
    image.dropped = image.count == 5 || image.count == 6 || image.count == 9;
  };
  V4l2Camera camera(system, at_once());
  const auto images = take(camera, 10);
  ASSERT_EQ(images.size(), 10u);
  EXPECT_EQ(camera.counts().lost, 3);
  // The numbers keep the gaps: image k has number k - 1, since image 0 was dropped as stale.
  for (const Taken& image : images) EXPECT_EQ(image.sequence, image.count - 1);
}

TEST(V4l2Camera, AReaderThatIsTooSlowLosesImagesAndKnowsHowMany) {
  ScriptedV4l2 system;
  V4l2Camera camera(system, at_once());
  ASSERT_EQ(take(camera, 1).size(), 1u);
  // One buffer of eight is held here: of the 20 images that are due while nobody reads, seven
  // find a place.
  system.pause(20 * 20ms);
  const auto images = take(camera, 30);
  ASSERT_EQ(images.size(), 30u);
  for (const Taken& image : images) EXPECT_EQ(image.sequence, image.count - 1);
  EXPECT_EQ(camera.counts().lost, 20 - 7);
}

/// How a driver can hand over an image that is of no use.
struct Spoiling {
  const char* name;
  std::uint32_t format;
  void (*spoil)(ScriptedV4l2::Image&);
};
void PrintTo(const Spoiling& spoiling, std::ostream* out) {
  *out << spoiling.name;
}

class V4l2Damage : public testing::TestWithParam<Spoiling> {};

TEST_P(V4l2Damage, IsSkippedAndCounted) {
  ScriptedV4l2 system;
  system.modes = {{GetParam().format, 64, 48, {{1, 50}}}};
  system.spoil = [](ScriptedV4l2::Image& image) {
    if (image.count == 4 || image.count == 7) GetParam().spoil(image);
  };
  V4l2Camera camera(system, at_once());
  const auto images = take(camera, 10);
  ASSERT_EQ(images.size(), 10u);
  for (const Taken& image : images) {
    EXPECT_NE(image.count, 4u);
    EXPECT_NE(image.count, 7u);
    EXPECT_EQ(image.sequence, image.count - 1);
  }
  EXPECT_EQ(camera.counts().damaged, 2);
  EXPECT_EQ(camera.counts().lost, 0);
  EXPECT_EQ(camera.counts().reconnections, 0);
  EXPECT_EQ(system.violations, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Ways, V4l2Damage,
    testing::Values(Spoiling{"flagged", V4L2_PIX_FMT_YUYV,
                             [](ScriptedV4l2::Image& image) { image.flags = V4L2_BUF_FLAG_ERROR; }},
                    Spoiling{"one byte short", V4L2_PIX_FMT_YUYV,
                             [](ScriptedV4l2::Image& image) { image.bytes_used -= 1; }},
                    Spoiling{"one byte short", V4L2_PIX_FMT_NV12,
                             [](ScriptedV4l2::Image& image) { image.bytes_used -= 1; }},
                    Spoiling{"longer than its memory", V4L2_PIX_FMT_YUYV,
                             [](ScriptedV4l2::Image& image) { image.bytes_used = 0xffffffffU; }},
                    Spoiling{"empty", V4L2_PIX_FMT_MJPEG,
                             [](ScriptedV4l2::Image& image) { image.bytes_used = 0; }},
                    Spoiling{"not a JPEG", V4L2_PIX_FMT_MJPEG,
                             [](ScriptedV4l2::Image& image) { image.bytes[1] = 0; }}));

TEST(V4l2Camera, GoesOnWhenTheDriversCountRunsOver) {
  ScriptedV4l2 system;
  system.spoil = [](ScriptedV4l2::Image& image) { image.sequence += 0xfffffffaU; };
  V4l2Camera camera(system, at_once());
  const auto images = take(camera, 12);
  ASSERT_EQ(images.size(), 12u);
  for (std::uint32_t n = 0; n < 12; ++n) EXPECT_EQ(images[n].sequence, n);
  EXPECT_EQ(camera.counts().lost, 0);
}

TEST(V4l2Camera, StampsThatCannotBeTrueAreReplacedByTheClock) {
  ScriptedV4l2 system;
  system.spoil = [](ScriptedV4l2::Image& image) {
    if (image.count % 4 == 1) image.stamp = 0ns;           // never set
    if (image.count % 4 == 2) image.stamp += 3600s;        // of another clock
    if (image.count % 4 == 3) image.stamp = -image.stamp;  // nonsense
  };
  V4l2Camera camera(system, at_once());
  double last_s = 0;
  for (const Taken& image : take(camera, 20)) {
    EXPECT_GT(image.time_s, last_s);
    EXPECT_LE(image.time_s, std::chrono::duration<double>(system.now()).count());
    last_s = image.time_s;
  }
  EXPECT_GT(last_s, 0);
}

TEST(V4l2Camera, SettlesBeforeTheFirstImage) {
  ScriptedV4l2 system;
  const auto before = system.now();
  V4l2Camera camera(system, {});
  // 1.5 s for the automatics and .2 s for images exposed before they were locked.
  EXPECT_GE(system.now() - before, 1700ms);
  const auto images = take(camera, 1);
  ASSERT_EQ(images.size(), 1u);
  // 1.7 s are 85 images of 20 ms.
  EXPECT_GE(images[0].count, 85u);
  EXPECT_EQ(images[0].sequence, 0u);
  EXPECT_EQ(camera.counts().lost, 0);
}

}  // namespace
}  // namespace sheen::capture
