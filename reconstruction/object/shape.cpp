// SPDX-License-Identifier: MIT
#include "reconstruction/object/shape.h"

#include "core/concurrency/parallel_for.h"
#include "reconstruction/hull/visual_hull.h"
#include "reconstruction/object/refusals.h"
#include "reconstruction/stage/print_check.h"
#include "reconstruction/surface/marching_tetrahedra.h"
#include "reconstruction/views/depth_image.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace sheen::reconstruction {
namespace {

constexpr float kHighest = 0.8F;       // of the lowest camera: an object ends below
constexpr float kSpaceMargin = 0.05F;  // of the tags' extent, where an object is looked for
constexpr float kFoot = 0.06F;         // of the space: objects stand on the sheet
constexpr int kMaskGrown_px = 2;

Components standing_in(DistanceGrid& grid) {
  return find_standing(kFoot * grid.box().sizes().maxCoeff(), grid);
}

}  // namespace

Eigen::AlignedBox3f Shape::grown(float share) const {
  const Eigen::Vector3f margin =
      Eigen::Vector3f::Constant(share * box.sizes().maxCoeff() + 2 * grid.cell_m());
  return {box.min() - margin, box.max() + margin};
}

Eigen::AlignedBox3f space_above(const capture::Board& board, const ViewSet& views) {
  const Eigen::AlignedBox2f tags = tags_region(board);
  const Eigen::Vector2f margin = kSpaceMargin * tags.sizes();
  const Eigen::AlignedBox2f region(tags.min() - margin, tags.max() + margin);
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
  std::size_t kept = 0;
  while (kept < components.parts.size() && !inner.contains(components.parts[kept].box)) ++kept;
  if (kept == components.parts.size()) kept = 0;
  keep_component(components, static_cast<int>(kept), grid);
  return {std::move(grid), components.parts[kept].box};
}

Shape only_shape(const std::filesystem::path& session, const capture::Board& board,
                 DistanceGrid grid) {
  const Components components = standing_in(grid);
  refuse_empty_sheet(session, components);
  refuse_what_stands_there(session, board, components);
  keep_component(components, 0, grid);
  return {std::move(grid), components.parts.front().box};
}

}  // namespace sheen::reconstruction
