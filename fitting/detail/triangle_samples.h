// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
#include "fitting/detail/surface_texels.h"
#include "fitting/detail/texel_means.h"
#include "fitting/detail/view_raster.h"
#include "fitting/sparse/sample_pool.h"
#include "fitting/sparse/sample_store.h"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// What a view showed of a triangle, or several views of nearly the same direction.
struct TriangleSample {
  Eigen::Vector3f w;    ///< unit, towards the viewer
  Eigen::Vector3f rgb;  ///< mean over the triangle's texels, sRGB
  float weight;         ///< views that were averaged into it times the squared cosine
};

/// The mean colours of every triangle's texels in the views that show all of them.
class TriangleSamples {
 public:
  /// At most `most` samples of a triangle are kept. The others outlive it.
  TriangleSamples(const core::Mesh& mesh, const SurfaceTexels& surface, std::size_t most,
                  int threads);

  /// Adds a view; `triangles` are its colours, that count where a triangle is a front in `raster`.
  /// The same on any number of threads.
  void integrate(const core::Observation& observation, const ViewRaster& raster,
                 std::span<const CornerColours> triangles);

  [[nodiscard]] std::size_t triangle_count() const { return stores_.size(); }
  /// Middle of a triangle's texels.
  [[nodiscard]] const Eigen::Vector3f& middle(std::size_t triangle) const {
    return middle_[triangle];
  }
  [[nodiscard]] std::vector<TriangleSample> of(std::size_t triangle) const;

 private:
  [[nodiscard]] Eigen::Vector3f normal(std::size_t triangle) const;

  const core::Mesh& mesh_;
  const SurfaceTexels& surface_;
  std::size_t most_;
  int threads_;
  std::vector<Eigen::Vector3f> middle_;
  sparse::SamplePool pool_;
  std::vector<sparse::SampleStore> stores_;
};

}  // namespace sheen::fitting::detail
