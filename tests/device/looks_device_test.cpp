// SPDX-License-Identifier: MIT
// What the start window shows of the machine's cameras.
#include "app/start/camera_looks.h"
#include "tests/device/rig.h"

#include <algorithm>

namespace sheen::capture::test {
namespace {

using DeviceLooks = RigTest;

TEST_F(DeviceLooks, EveryListedCameraShowsItsPictureOrOneLine) {
  const app::CameraAccess cameras = app::cameras_of_this_machine();
  const auto listed = cameras.list();
  ASSERT_TRUE(std::ranges::any_of(
      listed, [](const CameraListing& camera) { return camera.device == webcam_node; }));
  for (const CameraListing& camera : listed) {
    const app::CameraLook look = app::look_through(cameras, camera.device.string(), camera.name);
    EXPECT_NE(look.picture.empty(), look.fault.empty()) << camera.device;
    EXPECT_EQ(look.fault.find('\n'), std::string::npos);
    if (camera.device == webcam_node) {
      EXPECT_FALSE(look.picture.empty()) << look.fault;
    }
  }
}

TEST_F(DeviceLooks, ACameraThatIsNotThereIsOneLine) {
  const app::CameraLook look =
      app::look_through(app::cameras_of_this_machine(), "/dev/no-such-camera", "");
  EXPECT_NE(look.fault.find("/dev/no-such-camera"), std::string::npos) << look.fault;
}

}  // namespace
}  // namespace sheen::capture::test
