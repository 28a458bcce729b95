// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/tangent_frame.h"
#include "core/mesh/mesh.h"
#include "fitting/billboard/frame.h"
#include "fitting/patch_light_field.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace sheen::fitting::billboard {

/// Takes frames of a light field of patches, one after the other. Keeps its storage from frame to
/// frame.
class FrameBaker {
 public:
  /// Mesh, tangent frames (core::tangent_frames) and light field outlive it. A pixel is the mean of
  /// `samples` x `samples` points within it; 1: a hard outline.
  FrameBaker(const core::Mesh& mesh, const std::vector<core::TangentFrame>& frames,
             const PatchLightField& light_field, int samples);

  /// The sphere that `camera` was made for holds the mesh.
  FrameImage bake(const FrameCamera& camera);

 private:
  /// A vertex on the finer image that is drawn, pixels; z towards the camera, metres.
  struct Corner {
    float x, y, z, magnification;
  };
  /// What a point of the finer image shows.
  struct Seen {
    std::uint32_t triangle_idx = std::numeric_limits<std::uint32_t>::max();
    float z = -std::numeric_limits<float>::infinity();
    float weight_1 = 0,
          weight_2 = 0;  ///< of the triangle's second and third corner, on the surface
    [[nodiscard]] bool object() const { return z > -std::numeric_limits<float>::infinity(); }
  };

  void project(const FrameCamera& camera);
  void draw_triangle(std::uint32_t triangle_idx);
  void evaluate(const FrameCamera& camera);
  [[nodiscard]] WeightedColour shade(const Seen& seen) const;
  [[nodiscard]] cv::Rect box() const;
  void resolve(const cv::Point& pixel, float radius_m, cv::Vec3b& colour, cv::Vec3b& shape) const;

  const core::Mesh& mesh_;
  const std::vector<core::TangentFrame>& frames_;
  const PatchLightField& light_field_;
  int samples_;
  int side_ = 0;  ///< of the finer image
  std::vector<Corner> corners_;
  std::vector<Seen> seen_;
  std::vector<std::uint8_t> needed_;
  std::vector<WeightedColour> colours_;
};

}  // namespace sheen::fitting::billboard
