// SPDX-License-Identifier: MIT
#include "capture/source/open_camera.h"

#include "capture/source/network_address.h"
#include "capture/source/network_camera.h"

namespace sheen::capture {

std::unique_ptr<Camera> open_camera(const V4l2CameraOptions& wish) {
  const std::string address = wish.device.string();
  if (!is_network_address(address)) {
    return std::make_unique<V4l2Camera>(kernel_v4l2_system(), wish);
  }
  if (wish.mode.size || wish.mode.fps || wish.mode.format || !wish.controls.empty()) {
    throw core::bad_input(shown_address(address),
                          "takes no size, rate, format or controls from here",
                          "set them in the app that serves the images");
  }
  return std::make_unique<NetworkCamera>(NetworkCameraOptions{.address = address});
}

}  // namespace sheen::capture
