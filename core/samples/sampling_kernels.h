// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/lens/lens.h"
#include "core/samples/vertex_view.h"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sheen::core {

/// One camera and one pose in single precision: enough for 1/1000 pixel at arm's length.
struct ProjectionSetup {
  float rotation[9];     ///< of camera_from_object, row-major
  float translation[3];  ///< of camera_from_object, metres
  float eye[3];          ///< object frame, metres
  float focal_px[2];
  float principal_px[2];
  LensKind lens;
  float distortion[8];  ///< of the lens, core/geometry/lens/lens.h
  float valid_radius2;  ///< CameraModel::valid_radius, squared
  float low_px;         ///< where pixels may lie, both directions
  float high_px[2];     ///< and up to where
  float min_cosine;     ///< SamplingLimits
};

/// Columns of SurfacePoints, then those of VertexView.
struct ProjectionColumns {
  const float *x, *y, *z, *nx, *ny, *nz;
  float *x_px, *y_px, *depth_m, *u, *v;
  VertexRejection* rejection;
};

/// A CV_8UC3 image.
struct ImageView {
  const std::uint8_t* pixels;
  std::size_t row_bytes;
};

/// Columns of VertexView, then those of SampleBatch.
struct ReadingColumns {
  const float *view_x_px, *view_y_px, *view_u, *view_v;
  const std::uint32_t* patch;
  float *u, *v, *r, *g, *b;
};

/// The inner loops of sampling for one instruction set. All give the same bits.
struct SamplingKernels {
  std::string_view instruction_set;  ///< "portable", "avx2"
  /// Projects the vertices [begin, end), see `project_vertices`.
  void (*project)(const ProjectionSetup&, const ProjectionColumns&, std::size_t begin,
                  std::size_t end);
  /// Fills the samples [0, count) of the patches named, whose four pixels must exist.
  void (*read)(const ImageView&, const ReadingColumns&, std::size_t count);
};

/// All that this processor can run, the fastest first; "portable" is always among them.
const std::vector<SamplingKernels>& sampling_kernel_sets();

}  // namespace sheen::core
