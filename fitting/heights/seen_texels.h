// SPDX-License-Identifier: MIT
#pragma once

#include "core/concurrency/parallel_for.h"
#include "core/geometry/camera.h"
#include "core/image/bilinear.h"
#include "core/mesh/mesh.h"
#include "core/samples/surface_points.h"
#include "core/samples/vertex_view.h"
#include "fitting/detail/surface_texels.h"
#include "fitting/detail/view_raster.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting::heights {

/// An image and where it was taken from. Points to its camera.
struct PosedImage {
  cv::Mat image;                         ///< CV_8UC3 BGR, lens distortion included
  const core::CameraModel* camera;       ///< of this image
  Eigen::Isometry3d camera_from_object;  ///< metres
};

/// A texel as a view shows it.
struct SeenTexel {
  std::uint32_t texel_idx;
  std::array<float, 3> corner_weight;  ///< where it lies on its triangle, sum 1
  float weight;                        ///< squared cosine between normal and view
  std::array<float, 3> rgb;            ///< 0 to 255, bilinear
  /// How far on the atlas, texels per metre, the place that is seen moves when the surface rises.
  Eigen::Vector2f slide;
};

/// How a flat triangle lies in space and on the atlas.
struct TrianglePlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit; zero without area
  /// What a metre along the surface is on the atlas, texels.
  Eigen::Matrix<float, 2, 3> atlas_from_object = Eigen::Matrix<float, 2, 3>::Zero();
  /// What a texel along the atlas is on the surface, metres.
  Eigen::Matrix<float, 3, 2> object_from_atlas = Eigen::Matrix<float, 3, 2>::Zero();
};

/// Looks at the texels of a mesh in one view after the other.
class SeenTexels {
 public:
  /// All outlive it; `atlas` and `surface` are of a mesh with the same triangles.
  SeenTexels(const core::Mesh& mesh, const core::Atlas& atlas, const detail::SurfaceTexels& surface,
             int threads);

  void set_view(const PosedImage& view);

  /// Calls `visit(triangle_idx, texel)` for every texel that is seen; those of a triangle on one
  /// thread, in order.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    core::parallel_for(planes_.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) visit_triangle(t, visit);
    });
  }

  [[nodiscard]] const std::vector<TrianglePlane>& planes() const { return planes_; }
  [[nodiscard]] const core::VertexView& vertices() const { return vertices_; }
  /// Whether a vertex lies on the outline of what the view shows of the mesh.
  [[nodiscard]] bool is_at_outline(std::size_t vertex_idx) const;

 private:
  template <typename Visit>
  void visit_triangle(std::size_t triangle_idx, const Visit& visit) const;

  const core::Mesh& mesh_;
  const detail::SurfaceTexels& surface_;
  int threads_;
  core::SurfacePoints points_;
  std::vector<TrianglePlane> planes_;
  detail::ViewRaster raster_;
  core::VertexView vertices_;
  cv::Mat image_;
  Eigen::Vector3f eye_ = Eigen::Vector3f::Zero();
};

template <typename Visit>
void SeenTexels::visit_triangle(std::size_t triangle_idx, const Visit& visit) const {
  constexpr float least_cosine = 0.2f;  // as ViewRaster, but of the flat triangle
  const TrianglePlane& plane = planes_[triangle_idx];
  if (!raster_.is_front(triangle_idx) || plane.normal.isZero(0)) return;
  const detail::SeenTriangle triangle = raster_.triangle(triangle_idx);
  const auto& corners = mesh_.triangles[triangle_idx];
  const std::span<const detail::SurfaceTexel> texels = surface_.of(triangle_idx);
  for (std::size_t first = 0; first < texels.size(); first += 4) {
    const detail::FourWeights weights = detail::weights_of_four(&texels[first]);
    const detail::FourPlaces places = raster_.places(triangle, weights);
    detail::for_bits(places.seen & detail::bits_below(texels.size() - first), [&](std::size_t i) {
      const std::array<float, 3> weight{weights[0][i], weights[1][i], weights[2][i]};
      const Eigen::Vector3f towards_eye = eye_ - (weight[0] * mesh_.positions[corners[0]] +
                                                  weight[1] * mesh_.positions[corners[1]] +
                                                  weight[2] * mesh_.positions[corners[2]]);
      const float height = towards_eye.dot(plane.normal);
      if (!(height >= least_cosine * towards_eye.norm())) return;
      visit(triangle_idx,
            SeenTexel{texels[first + i].texel_idx, weight, places.cosine[i] * places.cosine[i],
                      core::bilinear_rgb(image_, {places.x_px[i], places.y_px[i]}),
                      plane.atlas_from_object * towards_eye / height});
    });
  }
}

}  // namespace sheen::fitting::heights
