// SPDX-License-Identifier: MIT
#include "reconstruction/object/shape.h"

#include "core/concurrency/parallel_for.h"
#include "reconstruction/object/refusals.h"
#include "reconstruction/surface/marching_tetrahedra.h"
#include "reconstruction/views/depth_image.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace sheen::reconstruction {
namespace {

constexpr float kHighest = 0.8F;  // of the lowest camera: an object ends below
constexpr float kFoot = 0.06F;    // of the space: objects stand on the sheet
constexpr int kMaskGrown_px = 2;
constexpr float kRival = 4;  // times as large an object may be as another piece that is kept

}  // namespace

Components standing_in(DistanceGrid& grid) {
  return find_standing(kFoot * grid.box().sizes().maxCoeff(), grid);
}

Eigen::AlignedBox3f Shape::grown(float share) const {
  const Eigen::Vector3f margin =
      Eigen::Vector3f::Constant(share * box.sizes().maxCoeff() + 2 * grid.cell_m());
  return {box.min() - margin, box.max() + margin};
}

Eigen::AlignedBox3f space_above(const Eigen::AlignedBox2f& region, const ViewSet& views) {
  float top = region.sizes().maxCoeff();
  for (const View& view : views.views) top = std::min(top, kHighest * view.project.eye().z());
  return {Eigen::Vector3f(region.min().x(), region.min().y(), 0),
          Eigen::Vector3f(region.max().x(), region.max().y(), std::max(top, 0.01F))};
}

std::vector<cv::Mat> masks_of(const Shape& shape, const ViewSet& views, int threads) {
  const core::Mesh surface = march_tetrahedra(shape.grid);
  std::vector<cv::Mat> masks(views.views.size());
  const int side = 1 + 2 * kMaskGrown_px;
  const cv::Mat element = cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
  core::parallel_for(
      masks.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          cv::dilate(draw_depth(surface, views.views[v].project).mask(), masks[v], element);
        }
      },
      1);
  return masks;
}

Shape likeliest_shape(const std::filesystem::path& session, DistanceGrid grid) {
  const Components components = standing_in(grid);
  refuse_empty_sheet(session, components);
  // What reaches the space's sides goes on beyond them.
  const Eigen::Vector3f margin(1.5F * grid.cell_m(), 1.5F * grid.cell_m(), -1);
  const Eigen::AlignedBox3f inner(grid.box().min() + margin, grid.box().max() - margin);
  std::size_t first = 0;
  while (first < components.parts.size() && !inner.contains(components.parts[first].box)) ++first;
  if (first == components.parts.size()) first = 0;
  const Component& object = components.parts[first];
  std::vector<int> kept{static_cast<int>(first)};
  Eigen::AlignedBox3f box = object.box;
  for (std::size_t i = first + 1; i < components.parts.size(); ++i) {
    const Component& other = components.parts[i];
    if (kRival * static_cast<float>(other.points) < static_cast<float>(object.points)) break;
    if (!inner.contains(other.box)) continue;
    kept.push_back(static_cast<int>(i));
    box.extend(other.box);
  }
  keep_components(components, kept, grid);
  return {std::move(grid), box};
}

Shape only_shape(const std::filesystem::path& session, const capture::Board& board,
                 DistanceGrid grid) {
  const Components components = standing_in(grid);
  refuse_empty_sheet(session, components);
  refuse_what_stands_there(session, board, components);
  keep_components(components, {0}, grid);
  return {std::move(grid), components.parts.front().box};
}

}  // namespace sheen::reconstruction
