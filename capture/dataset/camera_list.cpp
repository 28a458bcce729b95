// SPDX-License-Identifier: MIT
#include "capture/dataset/camera_list.h"

#include <algorithm>

namespace sheen::capture {

std::size_t CameraList::add(const core::CameraModel& camera,
                            std::vector<core::CameraModel>& cameras) {
  const core::CameraModel::Intrinsics& lens = camera.intrinsics();
  std::array<double, 15> key{static_cast<double>(lens.width_px),
                             static_cast<double>(lens.height_px),
                             lens.focal_px.x(),
                             lens.focal_px.y(),
                             lens.principal_px.x(),
                             lens.principal_px.y(),
                             static_cast<double>(lens.lens)};
  std::copy(lens.distortion.begin(), lens.distortion.end(), key.begin() + 7);
  const auto [known, is_new] = index_.try_emplace(key, cameras.size());
  if (is_new) cameras.push_back(camera);
  return known->second;
}

}  // namespace sheen::capture
