// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "fitting/depth_quads/depth_quads.h"
#include "render/views/ray_grid.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core/types.hpp>

#include <cstddef>
#include <vector>

namespace sheen::render {

/// Photographs nearer than this count alike, radians.
inline constexpr double kLeastAngle = 0.01;
/// Of quads that stand alone in depth: what they show counts where there is nothing else.
inline constexpr float kFlierCertainty = 1e-4f;

/// A cell of a photograph, enlarged, in the plane z = 1 of its camera. The quad is that square at
/// its depth.
struct CellQuad {
  Eigen::Vector2d middle, along, down;  ///< of the square; its sides
  float depth_m;
  float certainty;         ///< how much its colour counts, kFlierCertainty to 1
  float first_x, first_y;  ///< its upper left corner in the crop, pixels
};

/// A quad P0 + a U + b V, a and b in [0, 1], as a camera sees it. The ray r = (x, y, 1) of a pixel
/// meets its plane where r . to_a = a * r . normal and r . to_b = b * r . normal, with
/// normal = U x V, to_a = V x P0, to_b = P0 x U (Cramer's rule), all three negated where P0 .
/// normal is negative; there 1 / depth = r . normal / |P0 . normal|. So every pixel is exact,
/// whatever the lens, and one that does not see the quad is known by three products.
struct ScreenQuad {
  Eigen::Vector3f normal, to_a, to_b;
  float per_volume;              ///< 1 / |P0 . normal|
  float first_x, first_y;        ///< where a = b = 0 lies in the crop of its photograph, pixels
  float side_px;                 ///< of the quad in its photograph
  float tolerance;               ///< depths within this part of another are the same surface's
  float weight;                  ///< of its colour among others
  bool is_flier;                 ///< stands alone in depth: not to be trusted to hide anything
  int left, top, right, bottom;  ///< pixels that may see it, inclusive
};

/// The rays of a photograph's nodes, where they meet the plane z = 1 of its camera: node (i, j) is
/// the upper left corner of cell (i, j). Rows of columns + 1; NaN beyond the lens model. `rays` are
/// those of its camera.
std::vector<Eigen::Vector2f> node_rays(const fitting::KeptView& photograph,
                                       const fitting::depth_quads::QuadLevel& level,
                                       const RayGrid& rays);

/// The view that is drawn.
struct QuadCamera {
  const core::CameraModel& camera;
  Eigen::Isometry3d camera_from_object;
};

/// The coarsest level whose quads are at most two pixels wide in the view, or the finest.
std::size_t choose_level(const fitting::KeptView& photograph,
                         const fitting::depth_quads::QuadView& quads, const QuadCamera& viewer);

/// Depths within this part of each other are the same surface's.
float depth_tolerance(const fitting::KeptView& photograph,
                      const fitting::depth_quads::QuadLevel& level);

/// All quads of one level of a photograph that lie within its lens model, row by row.
std::vector<CellQuad> cell_quads(const fitting::KeptView& photograph,
                                 const fitting::depth_quads::QuadView& quads, std::size_t level_idx,
                                 const std::vector<Eigen::Vector2f>& nodes, double enlargement_px);

/// Quads of one level of a photograph that a view may see: those in front of it, wholly within its
/// lens model and turned towards it. Weights fall with the angle between photograph and view, and
/// beside holes and jumps of depth, where pixels mix two surfaces, and most for fliers.
std::vector<ScreenQuad> screen_quads(const fitting::KeptView& photograph,
                                     const fitting::depth_quads::QuadView& quads,
                                     std::size_t level_idx,
                                     const std::vector<Eigen::Vector2f>& nodes,
                                     double enlargement_px, const QuadCamera& viewer, int threads);

}  // namespace sheen::render
