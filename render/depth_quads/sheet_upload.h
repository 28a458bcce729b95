// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/depth_quads/depth_quads.h"
#include "render/gl/owners.h"
#include "render/views/ray_grid.h"

#include <cstddef>
#include <vector>

namespace sheen::render {

/// A photograph and its quads on the GPU, all levels of detail. The context is current in all
/// calls; `gl` outlives it.
class SheetUpload {
 public:
  struct Level {
    gl::Buffer cells;  ///< records of kBytesPerCell, as depth_quads/quads.vert has its attributes
    GLsizei count = 0;
  };
  static constexpr GLsizei kBytesPerCell = 10 * sizeof(float);

  /// `rays` are those of the photograph's camera. Throws core::Error: bad_input when the photograph
  /// cannot be decoded, run_failed when it is too large for the driver.
  SheetUpload(const gl::Functions& gl, const fitting::KeptView& photograph,
              const fitting::depth_quads::QuadView& quads, double enlargement_px,
              const RayGrid& rays);

  [[nodiscard]] GLuint photograph() const { return photograph_.name(); }
  [[nodiscard]] const Level& level(std::size_t level_idx) const { return levels_[level_idx]; }
  [[nodiscard]] std::size_t byte_size() const { return byte_size_; }

 private:
  gl::Texture photograph_;
  std::vector<Level> levels_;
  std::size_t byte_size_ = 0;
};

}  // namespace sheen::render
