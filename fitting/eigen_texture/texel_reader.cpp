// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/texel_reader.h"

#include "core/concurrency/parallel_for.h"
#include "core/image/bilinear.h"

#include <algorithm>
#include <span>

namespace sheen::fitting::eigen_texture {

std::vector<std::uint32_t> used_texels(const core::Atlas& atlas,
                                       const detail::SurfaceTexels& surface,
                                       std::size_t triangle_count) {
  std::vector<std::uint8_t> is_used(atlas.texel_count(), 0);
  for (std::size_t t = 0; t < triangle_count; ++t) {
    for (const detail::SurfaceTexel& texel : surface.of(t)) is_used[texel.texel_idx] = 1;
  }
  std::vector<std::uint32_t> used;
  for (std::uint32_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i] != 0) used.push_back(i);
  }
  return used;
}

TexelReader::TexelReader(const core::Mesh& mesh, const core::Atlas& atlas, int threads)
    : mesh_(mesh),
      threads_(threads),
      surface_(atlas),
      raster_(mesh, threads),
      used_(used_texels(atlas, surface_, mesh.triangles.size())),
      by_texel_(atlas.texel_count()) {}

std::vector<SeenTexel> TexelReader::read(const core::Observation& observation) {
  raster_.set_view(observation);
  // A texel belongs to one triangle: no two threads write the same one.
  core::parallel_for(mesh_.triangles.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      read_triangle(static_cast<std::uint32_t>(t), observation);
    }
  });
  std::vector<SeenTexel> seen;
  for (std::uint32_t slot = 0; slot < used_.size(); ++slot) {
    const SeenTexel& texel = by_texel_[used_[slot]];
    if (texel.weight > 0) seen.push_back({slot, texel.rgb, texel.weight});
  }
  return seen;
}

void TexelReader::read_triangle(std::uint32_t triangle_idx, const core::Observation& observation) {
  const std::span<const detail::SurfaceTexel> texels = surface_.of(triangle_idx);
  for (const detail::SurfaceTexel& texel : texels) by_texel_[texel.texel_idx].weight = 0;
  if (!raster_.is_front(triangle_idx)) return;
  const detail::SeenTriangle triangle = raster_.triangle(triangle_idx);
  const auto without_gain = static_cast<float>(1 / observation.gain);
  for (std::size_t first = 0; first < texels.size(); first += 4) {
    const detail::FourPlaces places =
        raster_.places(triangle, detail::weights_of_four(&texels[first]));
    detail::for_bits(places.seen & detail::bits_below(texels.size() - first), [&](std::size_t i) {
      SeenTexel& seen = by_texel_[texels[first + i].texel_idx];
      const std::array<float, 3> rgb =
          core::bilinear_rgb(observation.image, {places.x_px[i], places.y_px[i]});
      for (std::size_t channel = 0; channel < 3; ++channel) {
        seen.rgb[channel] =
            static_cast<std::uint8_t>(std::min(255.0f, rgb[channel] * without_gain) + 0.5f);
      }
      const float cosine = std::min(1.0f, places.cosine[i]);
      seen.weight = static_cast<std::uint8_t>(std::max(1.0f, cosine * cosine * 255.0f));
    });
  }
}

}  // namespace sheen::fitting::eigen_texture
