// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/tangent_frame.h"
#include "core/mesh/mesh.h"
#include "fitting/billboard/billboards.h"
#include "fitting/billboard/frame.h"
#include "fitting/billboard/frame_colours.h"
#include "fitting/patch_light_field.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace sheen::fitting::billboard {

/// Takes frames of an object, one after the other. Keeps its storage from frame to frame.
class FrameBaker {
 public:
  /// Mesh, tangent frames (core::tangent_frames) and light field outlive it. A pixel is the mean of
  /// `samples` x `samples` points within it; 1: a hard outline.
  FrameBaker(const core::Mesh& mesh, const std::vector<core::TangentFrame>& frames,
             const PatchLightField& light_field, int samples);
  /// The same of whatever has colours.
  FrameBaker(const core::Mesh& mesh, std::unique_ptr<FrameColours> colours, int samples);

  /// The sphere that `camera` was made for holds the mesh.
  FrameImage bake(const FrameCamera& camera);

 private:
  /// A vertex on the finer image that is drawn, pixels; z towards the camera, metres.
  struct Corner {
    float x, y, z, magnification;
  };
  /// What a point of the finer image shows.
  struct Seen {
    SurfacePoint point;
    float z = -std::numeric_limits<float>::infinity();
    [[nodiscard]] bool object() const { return z > -std::numeric_limits<float>::infinity(); }
  };

  void project(const FrameCamera& camera);
  void draw_triangle(std::uint32_t triangle_idx);
  void look_from(const FrameCamera& camera);
  [[nodiscard]] cv::Rect box() const;
  void resolve(const cv::Point& pixel, float radius_m, cv::Vec3b& colour, cv::Vec3b& shape) const;

  const core::Mesh& mesh_;
  std::unique_ptr<FrameColours> colours_;
  int samples_;
  int side_ = 0;  ///< of the finer image
  std::vector<Corner> corners_;
  std::vector<Seen> seen_;
  std::vector<std::uint8_t> needed_;
};

/// Points of a pixel, to either side, of frames that are kept: outlines have a dozen steps.
inline constexpr int kFrameSamples = 3;

/// Bakes all frames of `billboards` from patches. The same on any number of threads.
void bake_all(const core::Mesh& mesh, const std::vector<core::TangentFrame>& frames,
              const PatchLightField& patches, int threads, Billboards& billboards);

}  // namespace sheen::fitting::billboard
