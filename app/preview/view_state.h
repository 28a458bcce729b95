// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/layer.h"

namespace sheen::app {

/// What the person has chosen to see.
struct ViewState {
  Layer layer = Layer::radiance;
  bool camera_is_large = false;  ///< the camera's image in the middle, the model in the corner
  bool overlay = true;           ///< the object over the camera's image
  bool path = true;              ///< the cameras round the model
  bool help = false;
};

}  // namespace sheen::app
