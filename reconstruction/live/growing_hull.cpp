// SPDX-License-Identifier: MIT
#include "reconstruction/live/growing_hull.h"

#include "reconstruction/object/coarse_pass.h"
#include "reconstruction/object/outline_pass.h"
#include "reconstruction/object/refusals.h"
#include "reconstruction/surface/marching_tetrahedra.h"

#include <cmath>
#include <exception>
#include <utility>

namespace sheen::reconstruction {
namespace {

constexpr std::size_t kFewestViewsOfAHull = 8;
constexpr double kMostTexels = 1e5;
constexpr int kCells = 40;
constexpr double kSettled = 0.05;  // change of the volume from one run of passes to the next

double volume_of(const DistanceGrid& grid) {
  std::size_t inside = 0;
  for (std::size_t i = 0; i < grid.count(); ++i) inside += grid[i] < 0 ? 1 : 0;
  return static_cast<double>(inside) * std::pow(static_cast<double>(grid.cell_m()), 3);
}

}  // namespace

bool GrowingHull::step(const WalkViews& walk) {
  if (walk.views.size() < kFewestViewsOfAHull) return false;
  if (began_with_ == 0 || walk.lenses != lenses_ || 3 * walk.views.size() >= 4 * began_with_) {
    pass_ = 0;
    shape_.reset();
    if (walk.lenses != lenses_) news_.views = 0;
    began_with_ = walk.views.size();
    lenses_ = walk.lenses;
  }
  if (pass_ == kCoarsePasses) return false;
  try {
    shape_ = next_shape(walk);
    ++pass_;
    show(*shape_);
  } catch (const std::exception& error) {  // a hull that cannot be made ends no capture
    news_.doubt = error.what();
    pass_ = kCoarsePasses;  // until there are more views
  }
  return true;
}

Shape GrowingHull::next_shape(const WalkViews& walk) const {
  const ViewSet views = make_view_set(walk.camera, walk.views, 1);
  const CoarseGrids grids{plane_grid(views, stage_region(walk.board), kMostTexels),
                          object_region(walk.board), kCells};
  CoarseHull found = carve_coarsely(walk.board, views, grids, pass_, shape_ ? &*shape_ : nullptr, 1,
                                    [](std::string_view, int, int) {});
  if (pass_ + 1 < kCoarsePasses) return likeliest_shape(session_, std::move(found.grid));
  static_cast<void>(refuse_hidden_sheet(session_, walk.board, found.stage));
  return only_shape(session_, walk.board, std::move(found.grid));
}

void GrowingHull::show(const Shape& shape) {
  const bool is_last = pass_ == kCoarsePasses;
  if (!is_last && volume_m3_ > 0) return;
  news_.hull = std::make_shared<const core::Mesh>(march_tetrahedra(shape.grid));
  news_.doubt.clear();
  if (!is_last) return;
  news_.views = began_with_;
  const double before_m3 = std::exchange(volume_m3_, volume_of(shape.grid));
  news_.is_settled = std::abs(volume_m3_ - before_m3) < kSettled * volume_m3_;
}

}  // namespace sheen::reconstruction
