// SPDX-License-Identifier: MIT
#pragma once

#include "core/directions/view_sphere.h"
#include "core/mesh/mesh.h"
#include "fitting/eigen_texture/options.h"
#include "fitting/light_field.h"
#include "fitting/mean/mean_light_field.h"
#include "fitting/texture/surface_texture.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::eigen_texture {

/// The bases of one channel (luma_chroma.h) and their coefficients in every view.
struct Channel {
  std::size_t bases = 0;
  std::vector<std::int8_t> texels;        ///< [basis][used texel]
  std::vector<Eigen::half> coefficients;  ///< [view][basis], grey levels per step; below kMost
};
/// Largest absolute coefficient.
inline constexpr float kMostCoefficient = 7.99f;

/// A texture that depends on where it is seen from: mean + sum_k c_k(direction) basis_k, for luma
/// and two chroma differences apart. The coefficients are interpolated between those of the views.
/// After Cobzas, Yerex and Jagersand, "Dynamic Textures for Image-based Rendering" (2002).
class EigenTexture final : public LightField {
 public:
  /// Mid grey. `atlas` is one of `mesh`.
  EigenTexture(const core::Mesh& mesh, core::Atlas atlas);
  EigenTexture(const core::Mesh& mesh, SurfaceTexture mean);

  [[nodiscard]] std::string_view representation() const override { return "eigen-texture"; }
  /// Three per used texel of the mean and per vertex, one per number of the bases and coefficients.
  [[nodiscard]] std::size_t coefficient_count() const override;
  /// One: all of it.
  [[nodiscard]] std::size_t element_count() const override { return 1; }
  [[nodiscard]] std::vector<Eigen::Vector3f> vertex_colours(const core::Mesh& mesh) const override {
    return vertex_means_.vertex_colours(mesh);
  }

  [[nodiscard]] const SurfaceTexture& mean() const { return mean_; }
  [[nodiscard]] SurfaceTexture& mean() { return mean_; }
  /// Texels that hold some of the surface, ascending; bases have numbers for these.
  [[nodiscard]] const std::vector<std::uint32_t>& used() const { return used_; }
  [[nodiscard]] const mean::MeanLightField& vertex_means() const { return vertex_means_; }
  void set_vertex_means(const mean::MeanLightField& means) { vertex_means_ = means; }

  [[nodiscard]] const std::array<Channel, 3>& channels() const { return channels_; }
  /// Unit vectors from the object's centre to the views' cameras.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& directions() const { return directions_; }
  void set_bases(std::array<Channel, 3> channels, std::vector<Eigen::Vector3f> directions);

  /// From the object's centre to an eye (object frame, metres).
  [[nodiscard]] Eigen::Vector3f direction_to(const Eigen::Vector3f& eye) const;
  /// Coefficients of a channel's bases, seen from `eye`.
  [[nodiscard]] std::vector<float> coefficients(std::size_t channel,
                                                const Eigen::Vector3f& eye) const;

 private:
  Eigen::Vector3f centre_;
  SurfaceTexture mean_;
  std::vector<std::uint32_t> used_;
  mean::MeanLightField vertex_means_;
  std::array<Channel, 3> channels_;
  std::vector<Eigen::Vector3f> directions_;
  core::ViewSphere sphere_{{}};
};

}  // namespace sheen::fitting::eigen_texture
