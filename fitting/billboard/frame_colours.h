// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/tangent_frame.h"
#include "core/mesh/mesh.h"
#include "fitting/billboard/frame.h"
#include "fitting/patch_light_field.h"

#include <opencv2/core/types.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace sheen::fitting::billboard {

/// A point within a triangle.
struct SurfacePoint {
  std::uint32_t triangle_idx = std::numeric_limits<std::uint32_t>::max();
  float weight_1 = 0, weight_2 = 0;  ///< of the triangle's second and third corner, on the surface
};

/// What an object's surface looks like from the camera of a frame.
class FrameColours {
 public:
  virtual ~FrameColours() = default;

  /// Looks from another camera, which sees something around the vertices that `needed` flags.
  virtual void look_from(const FrameCamera& camera, std::span<const std::uint8_t> needed) = 0;

  /// Colour of a point that the camera sees, at a pixel of its image `FrameBaker` draws finer.
  [[nodiscard]] virtual WeightedColour at(const SurfacePoint& point,
                                          const cv::Point& fine_pixel) const = 0;
};

/// Those of patches. Mesh, tangent frames (core::tangent_frames) and light field outlive it.
class PatchColours final : public FrameColours {
 public:
  PatchColours(const core::Mesh& mesh, const std::vector<core::TangentFrame>& frames,
               const PatchLightField& light_field);

  void look_from(const FrameCamera& camera, std::span<const std::uint8_t> needed) override;
  [[nodiscard]] WeightedColour at(const SurfacePoint& point,
                                  const cv::Point& fine_pixel) const override;

 private:
  const core::Mesh& mesh_;
  const std::vector<core::TangentFrame>& frames_;
  const PatchLightField& light_field_;
  std::optional<FrameCamera> camera_;
  std::vector<WeightedColour> colours_;
};

}  // namespace sheen::fitting::billboard
