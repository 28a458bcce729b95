// SPDX-License-Identifier: MIT
#include "core/visibility/z_buffer.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <atomic>

namespace sheen::core {

ZBuffer::ZBuffer(const Mesh& mesh, int threads, const RasterKernels& kernels)
    : clusters_(mesh),
      threads_(std::max(1, threads)),
      kernels_(kernels),
      vertices_(mesh.positions.size()),
      maps_(static_cast<std::size_t>(threads_)) {}

bool ZBuffer::draw(const VertexView& view, const Eigen::Vector3f& eye, const PixelBox& box) {
  left_px_ = static_cast<float>(box.left);
  top_px_ = static_cast<float>(box.top);
  width_px_ = box.right - box.left + 1;
  height_px_ = box.bottom - box.top + 1;
  groups_ = (static_cast<std::size_t>(width_px_) + DepthMap::kGroup - 1) / DepthMap::kGroup;
  pack(view);

  // Every thread draws its share of the clusters into a map of its own. The nearest wins in any
  // order, so neither the share nor the map that a share meets shows in the result.
  std::vector<LargeTriangle> noted(maps_.size() * kMostLarge);
  std::vector<std::size_t> noted_counts(maps_.size(), 0);
  std::atomic<std::size_t> shares = 0;
  parallel_for(clusters_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    const std::size_t share = shares++;
    LargeTriangles large{noted.data() + share * kMostLarge, kMostLarge, 0};
    draw_clusters(begin, end, eye, maps_[share], large);
    noted_counts[share] = large.count;
  });
  merge(shares);

  // Hand over what was noted, unless it is too much in all.
  large_.clear();
  std::size_t total = 0;
  for (const std::size_t count : noted_counts) total += count;
  if (total > kMostLarge) return false;
  for (std::size_t share = 0; share < shares; ++share) {
    const auto first = noted.begin() + static_cast<std::ptrdiff_t>(share * kMostLarge);
    large_.insert(large_.end(), first, first + static_cast<std::ptrdiff_t>(noted_counts[share]));
  }
  return true;
}

void ZBuffer::pack(const VertexView& view) {
  parallel_for(vertices_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      vertices_[i].x = view.x_px[i] - left_px_;
      vertices_[i].y = view.y_px[i] - top_px_;
      vertices_[i].inverse_depth = view.depth_m[i] > 0.0f ? 1.0f / view.depth_m[i] : 0.0f;
    }
  });
}

void ZBuffer::draw_clusters(std::size_t begin, std::size_t end, const Eigen::Vector3f& eye,
                            Map& map, LargeTriangles& large) const {
  clear(map);
  const DepthMap target{map.data()->inverse_depth, width_px_, height_px_, row()};
  for (std::size_t cluster = begin; cluster < end; ++cluster) {
    if (clusters_.faces_away(cluster, eye)) continue;
    kernels_.draw(vertices_.data(),
                  {clusters_.corners(cluster, 0), clusters_.corners(cluster, 1),
                   clusters_.corners(cluster, 2), TriangleClusters::kTriangles},
                  kLarge_px, target, large);
  }
}

void ZBuffer::merge(std::size_t maps) {
  if (maps == 0) clear(maps_.front());
  Map& merged = maps_.front();
  parallel_for(merged.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t other = 1; other < maps; ++other) {
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t k = 0; k < DepthMap::kGroup; ++k) {
          float& inverse_depth = merged[i].inverse_depth[k];
          inverse_depth = std::max(inverse_depth, maps_[other][i].inverse_depth[k]);
        }
      }
    }
  });
}

void ZBuffer::clear(Map& map) const {
  map.assign(groups_ * static_cast<std::size_t>(height_px_ + DepthMap::kExtraRows), {});
}

}  // namespace sheen::core
