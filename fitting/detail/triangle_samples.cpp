// SPDX-License-Identifier: MIT
#include "fitting/detail/triangle_samples.h"

#include "core/concurrency/parallel_for.h"
#include "core/geometry/disc_map.h"
#include "core/geometry/tangent_frame.h"
#include "core/mesh/interpolation.h"
#include "core/samples/vertex_view.h"

#include <algorithm>

namespace sheen::fitting::detail {

TriangleSamples::TriangleSamples(const core::Mesh& mesh, const SurfaceTexels& surface,
                                 std::size_t most, int threads)
    : mesh_(mesh),
      surface_(surface),
      most_(most),
      threads_(threads),
      middle_(mesh.triangles.size(), Eigen::Vector3f::Zero()),
      stores_(mesh.triangles.size()) {
  for (std::size_t t = 0; t < middle_.size(); ++t) {
    for (const SurfaceTexel& texel : surface.of(t)) {
      middle_[t] +=
          Eigen::Vector3f(1.0f - texel.at_second - texel.at_third, texel.at_second, texel.at_third);
    }
    if (!surface.of(t).empty()) middle_[t] /= static_cast<float>(surface.of(t).size());
  }
}

void TriangleSamples::integrate(const core::Observation& observation, const ViewRaster& raster,
                                std::span<const CornerColours> triangles) {
  const Eigen::Vector3f eye = core::eye_in_object(observation.camera_from_object);
  pool_.reserve(stores_.size());
  core::parallel_for(stores_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const std::size_t texels = surface_.of(t).size();
      if (texels == 0 || !raster.is_front(t)) continue;
      const CornerColours& corners = triangles[t];
      const Four sum = corners.colour[0] + corners.colour[1] + corners.colour[2];
      if (sum[0] < static_cast<float>(texels) - 0.5f) continue;
      const core::DiscDirection seen = core::direction_towards(
          core::tangent_frame(normal(t)), core::place_on(mesh_, t, middle_[t]), eye);
      if (seen.cosine <= 0.0f) continue;
      const float per = 1.0f / (255.0f * sum[0]);
      stores_[t].add({seen.uv, per * Eigen::Vector3f(sum[1], sum[2], sum[3])}, most_, pool_);
    }
  });
}

std::vector<TriangleSample> TriangleSamples::of(std::size_t triangle) const {
  const sparse::SampleStore& store = stores_[triangle];
  const core::TangentFrame frame = core::tangent_frame(normal(triangle));
  std::vector<TriangleSample> samples(store.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto [uv, rgb] = store.at(i, pool_);
    samples[i] = {frame.in_object(core::hemisphere_from_disc(uv)), rgb,
                  store.count(i, pool_) * std::max(0.0f, 1.0f - uv.squaredNorm())};
  }
  return samples;
}

Eigen::Vector3f TriangleSamples::normal(std::size_t triangle) const {
  return core::normal_on(mesh_, triangle, middle_[triangle]);
}

}  // namespace sheen::fitting::detail
