// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/eigen_texture.h"

#include "core/mesh/bounds.h"
#include "fitting/detail/surface_texels.h"
#include "fitting/eigen_texture/texel_reader.h"

#include <utility>

namespace sheen::fitting::eigen_texture {

EigenTexture::EigenTexture(const core::Mesh& mesh, core::Atlas atlas)
    : EigenTexture(mesh, SurfaceTexture(std::move(atlas))) {}

EigenTexture::EigenTexture(const core::Mesh& mesh, SurfaceTexture mean)
    : centre_(core::bounds_of(mesh).center()),
      mean_(std::move(mean)),
      used_(
          used_texels(mean_.atlas(), detail::SurfaceTexels(mean_.atlas()), mesh.triangles.size())),
      vertex_means_(mesh.positions.size()) {}

std::size_t EigenTexture::coefficient_count() const {
  std::size_t count = 3 * used_.size() + vertex_means_.coefficient_count();
  for (const Channel& channel : channels_) {
    count += channel.texels.size() + channel.coefficients.size();
  }
  return count;
}

void EigenTexture::set_bases(std::array<Channel, 3> channels,
                             std::vector<Eigen::Vector3f> directions) {
  channels_ = std::move(channels);
  directions_ = std::move(directions);
  std::vector<Eigen::Vector3d> unit;
  for (const Eigen::Vector3f& one : directions_) unit.push_back(one.cast<double>().normalized());
  sphere_ = core::ViewSphere(std::move(unit));
}

Eigen::Vector3f EigenTexture::direction_to(const Eigen::Vector3f& eye) const {
  const Eigen::Vector3f direction = (eye - centre_).normalized();
  return direction.allFinite() && direction.norm() > 0.5f ? direction : Eigen::Vector3f::UnitZ();
}

std::vector<float> EigenTexture::coefficients(std::size_t channel,
                                              const Eigen::Vector3f& eye) const {
  const Channel& one = channels_[channel];
  std::vector<float> blended(one.bases, 0.0f);
  if (blended.empty()) return blended;
  const core::SphereBlend blend = sphere_.blend(direction_to(eye).cast<double>());
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::half* const of_view = one.coefficients.data() + blend.index[i] * one.bases;
    for (std::size_t k = 0; k < one.bases; ++k) {
      blended[k] += blend.weight[i] * static_cast<float>(of_view[k]);
    }
  }
  return blended;
}

}  // namespace sheen::fitting::eigen_texture
