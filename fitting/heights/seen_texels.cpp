// SPDX-License-Identifier: MIT
#include "fitting/heights/seen_texels.h"

#include "core/samples/observation.h"

#include <cmath>

namespace sheen::fitting::heights {
namespace {

TrianglePlane plane_of(const core::Mesh& mesh, const core::Atlas& atlas, std::size_t triangle_idx) {
  const auto& corner = mesh.triangles[triangle_idx];
  Eigen::Matrix<float, 3, 2> edges;
  edges.col(0) = mesh.positions[corner[1]] - mesh.positions[corner[0]];
  edges.col(1) = mesh.positions[corner[2]] - mesh.positions[corner[0]];
  Eigen::Matrix2f on_atlas;
  on_atlas.col(0) = atlas.place(triangle_idx, 1) - atlas.place(triangle_idx, 0);
  on_atlas.col(1) = atlas.place(triangle_idx, 2) - atlas.place(triangle_idx, 0);
  const Eigen::Matrix2d squared = (edges.transpose() * edges).cast<double>();
  const double determinant = squared.determinant();
  const Eigen::Vector3f across = edges.col(0).cross(edges.col(1));
  const float area = across.norm();
  const float on_atlas_area = std::abs(on_atlas.determinant());
  if (!(determinant > 1e-6 * squared.trace() * squared.trace()) || !(area > 0.0f) ||
      !(on_atlas_area > 1e-6f)) {
    return {};
  }
  return {across / area, on_atlas * squared.inverse().cast<float>() * edges.transpose(),
          edges * on_atlas.inverse()};
}

}  // namespace

SeenTexels::SeenTexels(const core::Mesh& mesh, const core::Atlas& atlas,
                       const detail::SurfaceTexels& surface, int threads)
    : mesh_(mesh),
      surface_(surface),
      threads_(threads),
      points_(core::surface_points(mesh)),
      planes_(mesh.triangles.size()),
      raster_(mesh, threads) {
  for (std::size_t t = 0; t < planes_.size(); ++t) planes_[t] = plane_of(mesh, atlas, t);
}

void SeenTexels::set_view(const PosedImage& view) {
  image_ = view.image;
  eye_ = core::eye_in_object(view.camera_from_object);
  core::project_vertices(points_, *view.camera, view.camera_from_object, {}, threads_, vertices_);
  raster_.set_view({.image = image_,
                    .camera = *view.camera,
                    .camera_from_object = view.camera_from_object,
                    .view = vertices_,
                    .samples = {}});
}

bool SeenTexels::is_at_outline(std::size_t vertex_idx) const {
  return vertices_.depth_m[vertex_idx] > 0.0f &&
         raster_.is_at_outline(vertices_.x_px[vertex_idx], vertices_.y_px[vertex_idx]);
}

}  // namespace sheen::fitting::heights
