// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/orbit_camera.h"
#include "render/renderer.h"

#include <opencv2/core.hpp>

namespace sheen::app {

/// A picture that shows all that the camera has framed, whatever the picture's shape. CV_8UC4, B G
/// R A, not premultiplied; outlines are smooth.
cv::Mat smooth_picture(render::Renderer& renderer, const OrbitCamera& camera,
                       const cv::Size& size_px);

}  // namespace sheen::app
