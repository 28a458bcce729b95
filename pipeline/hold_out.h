// SPDX-License-Identifier: MIT
#pragma once

namespace sheen::pipeline {

/// Which frames stay out of the fit: index % every == every / 2; 0 keeps none out.
struct HoldOut {
  int every = 0;
  [[nodiscard]] bool contains(int frame_index) const {
    return every > 0 && frame_index % every == every / 2;
  }
};

}  // namespace sheen::pipeline
