// SPDX-License-Identifier: MIT
#include "tests/device/rig.h"

#include <chrono>
#include <filesystem>
#include <fstream>

namespace sheen::capture::test {
namespace {

const std::filesystem::path vivid_driver = "/sys/bus/platform/drivers/vivid";

void write_to(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text << std::flush;
  ASSERT_TRUE(file) << path;
}

}  // namespace

void RigTest::SetUp() {
  if (!std::filesystem::exists(vivid_driver) || !std::filesystem::exists(loopback_node))
    GTEST_SKIP() << "no virtual cameras on this machine: scripts/test-v4l2 runs this test";
}

V4l2CameraOptions quick(const std::string& node) {
  V4l2CameraOptions options;
  options.device = node;
  options.mode.format = PixelFormat::yuyv;
  options.mode.size = ImageSize{640, 480};
  options.lock_automatics = false;
  return options;
}

void set_control(const std::string& node, const std::string& name, int value) {
  set_controls(V4l2Device(kernel_v4l2_system(), node), {{name, value}});
}

void press(const std::string& node, const std::string& name) {
  set_control(node, name, 0);
}

void unbind_vivid() {
  write_to(vivid_driver / "unbind", "vivid.0");
}
void bind_vivid() {
  write_to(vivid_driver / "bind", "vivid.0");
}

std::vector<Taken> take(V4l2Camera& camera, std::size_t wanted) {
  std::vector<Taken> images;
  for (std::size_t wait = 0; wait < wanted + 100 && images.size() < wanted; ++wait)
    if (const auto buffer = camera.next(std::chrono::milliseconds(100)))
      images.push_back({buffer->sequence, buffer->time_s});
  return images;
}

void expect_numbered_without_gap(const std::vector<Taken>& images) {
  for (std::size_t n = 1; n < images.size(); ++n)
    EXPECT_EQ(images[n].sequence, images[n - 1].sequence + 1);
}

void expect_times_grow(const std::vector<Taken>& images) {
  for (std::size_t n = 1; n < images.size(); ++n) EXPECT_GT(images[n].time_s, images[n - 1].time_s);
}

}  // namespace sheen::capture::test
