// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "evaluation/report/progress.h"

#include <array>
#include <cstddef>
#include <vector>

namespace sheen::evaluation {

/// The paper's experiment: fields of view of the viewer, degrees; those that frames are baked with,
/// 0: orthographic; distances of the viewer, multiples of that at which the object's sphere just
/// fits into his image.
inline constexpr std::array kViewFields_deg{40.0, 60.0, 90.0};
inline constexpr std::array kBakeFields_deg{0.0, 40.0, 60.0, 90.0};
inline constexpr std::array kDistances{0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0};

/// How images are made, billboards and those of the mesh alike.
struct BillboardImages {
  int side_px = 256;  ///< of frames and of images
  int samples = 1;    ///< points of a pixel to either side; 1: hard outlines, as in the paper
};

/// Differences of billboard and mesh, means over the viewers; one entry per distance. A pixel's is
/// |R - R'| + |G - G'| + |B - B'|, 0 to 765.
struct BillboardErrors {
  double view_field_deg;
  double bake_field_deg;
  std::array<double, kDistances.size()> total{};    ///< summed over the image
  std::array<double, kDistances.size()> average{};  ///< over the box of what either shows
};

/// Draws the nearest of 5,120 billboards for 14 viewers (six meridians at 30 degrees to either side
/// of the equator, both poles), and the mesh itself. The mesh is grey, lit from one side, on black.
/// One result for each of `view_fields` and `bake_fields`. The same on any number of threads.
std::vector<BillboardErrors> billboard_errors(const core::Mesh& mesh, const BillboardImages& images,
                                              const std::vector<double>& view_fields_deg,
                                              const std::vector<double>& bake_fields_deg,
                                              int threads, const Progress& progress);

/// What errors follow: E(d) = parallax / d + constant + outline d.
struct ErrorLaw {
  double parallax, constant, outline;
  /// Where it is least, a multiple of the fitting distance; infinite where outlines cost nothing.
  [[nodiscard]] double best_distance() const;
};

/// Fitted to the averages at distances 1 to 32, relative errors squared.
ErrorLaw fit_law(const BillboardErrors& errors);

}  // namespace sheen::evaluation
