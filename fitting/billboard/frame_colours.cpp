// SPDX-License-Identifier: MIT
#include "fitting/billboard/frame_colours.h"

#include "core/mesh/interpolation.h"

#include <cstddef>

namespace sheen::fitting::billboard {

PatchColours::PatchColours(const core::Mesh& mesh, const std::vector<core::TangentFrame>& frames,
                           const PatchLightField& light_field)
    : mesh_(mesh), frames_(frames), light_field_(light_field), colours_(mesh.positions.size()) {}

/// Evaluates the patches that the frame needs.
void PatchColours::look_from(const FrameCamera& camera, std::span<const std::uint8_t> needed) {
  camera_ = camera;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    if (needed[i] == 0) continue;
    const Eigen::Vector3f& position = mesh_.positions[i];
    colours_[i] = light_field_.interpolated_part(
        i, core::direction_towards(frames_[i], position, camera.viewer_of(position)).uv);
  }
}

WeightedColour PatchColours::at(const SurfacePoint& point, const cv::Point& /*fine_pixel*/) const {
  const auto& vertex = mesh_.triangles[point.triangle_idx];
  const Eigen::Vector3f weight(1.0f - point.weight_1 - point.weight_2, point.weight_1,
                               point.weight_2);
  WeightedColour sums{Eigen::Vector3f::Zero(), 0.0f};
  for (int corner = 0; corner < 3; ++corner) {
    sums.colour_sum += weight[corner] * colours_[vertex[corner]].colour_sum;
    sums.weight_sum += weight[corner] * colours_[vertex[corner]].weight_sum;
  }
  const Eigen::Vector3f place = core::place_on(mesh_, point.triangle_idx, weight);
  const Eigen::Vector3f w = (camera_->viewer_of(place) - place).normalized();
  sums.colour_sum += sums.weight_sum * light_field_.between_patches(point.triangle_idx, weight, w);
  return sums;
}

}  // namespace sheen::fitting::billboard
