// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/gltf_accessor.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace sheen::core {

/// What colour the vertices of a glTF file have: COLOR_0 times the base colour of the material
/// times that of its picture at the vertex, multiplied as light. Pictures are JPEGs or PNGs of
/// three channels of 8 bits, at most 16384 pixels a side and 2^26 in all; their wrapping is
/// repetition.
class GltfColours {
 public:
  /// Both outlive it.
  GltfColours(const GltfContainer& gltf, GltfAccessors& accessors)
      : gltf_(gltf), accessors_(accessors) {}

  /// sRGB in [0, 1], one for each of the primitive's `vertices`; empty where nothing says what
  /// colour they have. Throws GltfFault.
  std::vector<Eigen::Vector3f> of(const nlohmann::json& primitive, std::size_t vertices);

  /// What was passed over.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  void multiply_picture(const nlohmann::json& texture, const nlohmann::json& attributes,
                        std::vector<Eigen::Vector3d>& light);
  const cv::Mat& picture(std::size_t image_idx);

  const GltfContainer& gltf_;
  GltfAccessors& accessors_;
  std::map<std::size_t, cv::Mat> pictures_;  ///< CV_8UC3, by index; empty where unreadable
  double picture_pixels_ = 0;                ///< of all
  bool has_unread_picture_ = false;
  bool has_moved_picture_ = false;
  bool has_packed_colours_ = false;
};

}  // namespace sheen::core
