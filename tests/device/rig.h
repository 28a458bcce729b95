// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/v4l2_camera.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sheen::capture::test {

/// The cameras that tests/device/guest_init makes: vivid as a webcam, whose sizes and rates are
/// lists; vivid as a converter of 1280x720 at 60 images a second, which scales; v4l2loopback.
inline constexpr const char* webcam_node = "/dev/video0";
inline constexpr const char* converter_node = "/dev/video1";
inline constexpr const char* loopback_node = "/dev/video9";

/// A test that needs these cameras; skipped on a machine without them.
class RigTest : public testing::Test {
 protected:
  void SetUp() override;
};

/// The converter at 640x480, YUYV, without the wait for its automatics.
[[nodiscard]] V4l2CameraOptions quick(const std::string& node = converter_node);

/// Sets a control of a camera that may be streaming.
void set_control(const std::string& node, const std::string& name, int value);
/// Presses a button among the controls.
void press(const std::string& node, const std::string& name);

/// Takes both virtual cameras of vivid out of the machine and puts them in again.
void unbind_vivid();
void bind_vivid();

struct Taken {
  std::uint32_t sequence = 0;
  double time_s = 0;
};

/// Up to `wanted` images, given up after as many waits of .1 s and some more.
std::vector<Taken> take(V4l2Camera& camera, std::size_t wanted);

/// Every number is one more than the number before.
void expect_numbered_without_gap(const std::vector<Taken>& images);
/// Every time is later than the time before.
void expect_times_grow(const std::vector<Taken>& images);

}  // namespace sheen::capture::test
