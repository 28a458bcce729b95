// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/sample_batch.h"
#include "core/samples/vertex_view.h"

#include <opencv2/core/mat.hpp>

namespace sheen::core {

/// Reads the image under every vertex that is not rejected, bilinearly.
/// `image` is CV_8UC3 in OpenCV's BGR order; samples are RGB in [0, 1]. Reuses the storage of
/// `batch`: after the first views nothing is allocated.
void back_project(const cv::Mat& image, const VertexView& view, SampleBatch& batch);

}  // namespace sheen::core
