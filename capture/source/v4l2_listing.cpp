// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_listing.h"

namespace sheen::capture {

std::vector<CameraListing> list_cameras(V4l2System& system) {
  std::vector<CameraListing> cameras;
  for (const auto& node : system.video_nodes()) {
    CameraListing listing;
    listing.device = node;
    try {
      const V4l2Device device(system, node);
      listing.name = device.name();
      listing.bus = device.bus();
      listing.modes = camera_modes(device);
      listing.controls = camera_controls(device);
    } catch (const V4l2Error& error) {
      if (error.kind() == core::Error::Kind::bad_input) continue;
      listing.fault = error.fault();
    }
    cameras.push_back(std::move(listing));
  }
  return cameras;
}

}  // namespace sheen::capture
