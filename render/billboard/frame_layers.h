// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/billboard/billboards.h"
#include "render/gl/owners.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace sheen::render {

/// Frames on the GPU, as layers of two texture arrays: what billboard/billboards.frag reads. They
/// are sent when they are needed first; those that were not needed for longest make room. The
/// context is current in all calls; `gl` and the light field outlive it.
class FrameLayers {
 public:
  FrameLayers(const gl::Functions& gl, const fitting::billboard::Billboards& billboards);

  /// Sees to it that these frames (no repeats, none of them empty) are there. Throws core::Error:
  /// bad_input when one cannot be decoded, run_failed when the driver cannot hold them all.
  void hold(std::span<const std::size_t> frames);
  /// Of a frame that was held last.
  [[nodiscard]] int layer_of(std::size_t frame_idx) const { return layer_of_[frame_idx]; }
  /// What was sent is not what frames are now.
  void forget();
  void bind() const;

 private:
  static constexpr int kNowhere = -1;
  static constexpr std::size_t kEmpty = std::numeric_limits<std::size_t>::max();
  struct Layer {
    std::size_t frame_idx = kEmpty;
    std::uint64_t last_needed = 0;  ///< number of the call
  };

  void make_layers(std::size_t count);
  void send(std::size_t frame_idx, int layer);

  const gl::Functions& gl_;
  const fitting::billboard::Billboards& billboards_;
  gl::Texture colours_, shapes_;
  std::vector<Layer> layers_;
  std::vector<int> layer_of_;  ///< of every frame
  std::uint64_t calls_ = 0;
};

}  // namespace sheen::render
