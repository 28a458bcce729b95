// SPDX-License-Identifier: MIT
#include "fitting/detail/texture_sums.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <cmath>

namespace sheen::fitting::detail {
namespace {

struct TexelBox {
  int left, top, right, bottom;
};

/// Texels that readings within a triangle touch.
TexelBox box_of(const core::Atlas& atlas, std::size_t triangle_idx) {
  const Eigen::Vector2f a = atlas.place(triangle_idx, 0);
  const Eigen::Vector2f b = atlas.place(triangle_idx, 1);
  const Eigen::Vector2f c = atlas.place(triangle_idx, 2);
  const Eigen::Array2i least = (a.cwiseMin(b).cwiseMin(c).array() - 0.5f).floor().cast<int>();
  const Eigen::Array2i most = (a.cwiseMax(b).cwiseMax(c).array() - 0.5f).floor().cast<int>() + 1;
  // Places are rounded to an eighth of a texel.
  return {std::max(least.x(), 0), std::max(least.y(), 0), std::min(most.x() + 1, atlas.width - 1),
          std::min(most.y() + 1, atlas.height - 1)};
}

}  // namespace

TextureSums::TextureSums(const core::Mesh& mesh, const core::Atlas& atlas, int threads)
    : mesh_(mesh),
      atlas_(atlas),
      threads_(threads),
      texels_(atlas.texel_count()),
      pages_per_row_(static_cast<std::size_t>((atlas.width + kPage - 1) / kPage)) {
  const auto page_rows = static_cast<std::size_t>((atlas.height + kPage - 1) / kPage);
  page_is_touched_.resize(pages_per_row_ * page_rows);
  bands_.resize(page_rows);
  sort_into_bands();
}

// Bands of equal parity share no row, so each may be worked on by another thread.
void TextureSums::sort_into_bands() {
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    const TexelBox box = box_of(atlas_, t);
    const int band = box.top / kPage;
    if (box.bottom < (band + 2) * kPage) {
      bands_[static_cast<std::size_t>(band)].triangles.push_back(t);
    } else {
      high_.push_back(t);
    }
  }
}

void TextureSums::integrate(const core::Observation& observation, const ViewRaster& raster) {
  for (std::size_t value = 0; value < corrected_.size(); ++value) {
    corrected_[value] = static_cast<std::uint8_t>(std::clamp(
        std::lround(static_cast<double>(value) / observation.gain), 0L, 255L));
  }
  std::fill(page_is_touched_.begin(), page_is_touched_.end(), std::uint8_t{0});
  for (const std::size_t parity : {std::size_t{0}, std::size_t{1}}) {
    const std::size_t count = (bands_.size() + 1 - parity) / 2;
    core::parallel_for(
        count, threads_,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            for (const std::uint32_t t : bands_[2 * i + parity].triangles) {
              integrate_triangle(t, observation, raster);
            }
          }
        },
        1);
  }
  for (const std::uint32_t t : high_) integrate_triangle(t, observation, raster);
}

void TextureSums::integrate_triangle(std::uint32_t t, const core::Observation& observation, const ViewRaster& raster) {
  bool any = false;
  if (raster.area_px2(t) > 0.0f) {
    const std::array<Eigen::Vector2f, 3> corner{atlas_.place(t, 0), atlas_.place(t, 1),
                                                atlas_.place(t, 2)};
    const TexelGrid grid{texels_.data(), static_cast<std::size_t>(atlas_.width)};
    raster.for_each_pixel(t, [&](const SurfacePixel& pixel) {
      const std::uint8_t* const bgr =
          observation.image.ptr<std::uint8_t>(pixel.y_px) + 3 * pixel.x_px;
      std::array<std::uint32_t, 3> rgb{corrected_[bgr[2]], corrected_[bgr[1]],
                                             corrected_[bgr[0]]};
      if (pixel_offset) {
        const Eigen::Vector3f d = 255.0f * pixel_offset(t, pixel.weight, eye);
        for (int c = 0; c < 3; ++c) rgb[static_cast<size_t>(c)] = static_cast<std::uint32_t>(std::clamp(std::lround(static_cast<float>(rgb[static_cast<size_t>(c)]) - d[c]), 0L, 255L));
      } else if (!offset.empty()) {
        const auto& tri = mesh_.triangles[t];
        for (int c = 0; c < 3; ++c) {
          const float d = pixel.weight[0] * offset[tri[0]][c] + pixel.weight[1] * offset[tri[1]][c] + pixel.weight[2] * offset[tri[2]][c];
          rgb[static_cast<size_t>(c)] = static_cast<std::uint32_t>(std::clamp(std::lround(static_cast<float>(rgb[static_cast<size_t>(c)]) - d), 0L, 255L));
        }
      }
      const Eigen::Vector2f place = pixel.weight[0] * corner[0] + pixel.weight[1] * corner[1] +
                                    pixel.weight[2] * corner[2];
      add_pixel(grid, place, pixel.cosine, rgb);
      any = true;
    });
    if (any) touch_pages(t);
  }
}

void TextureSums::touch_pages(std::uint32_t t) {
  const TexelBox box = box_of(atlas_, t);
  for (int row = box.top / kPage; row <= box.bottom / kPage; ++row) {
    for (int column = box.left / kPage; column <= box.right / kPage; ++column) {
      page_is_touched_[static_cast<std::size_t>(row) * pages_per_row_ +
                       static_cast<std::size_t>(column)] = 1;
    }
  }
}

std::vector<std::uint32_t> TextureSums::touched_pages() const {
  std::vector<std::uint32_t> pages;
  for (std::uint32_t page = 0; page < page_is_touched_.size(); ++page) {
    if (page_is_touched_[page] != 0) pages.push_back(page);
  }
  return pages;
}

}  // namespace sheen::fitting::detail
