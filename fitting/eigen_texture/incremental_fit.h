// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/eigen_texture/eigen_texture.h"
#include "fitting/eigen_texture/factors.h"
#include "fitting/eigen_texture/texel_reader.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace sheen::fitting::eigen_texture {

/// Bases and coefficients while views arrive, each looked at once: incremental singular value
/// decomposition with missing data (Brand 2002), a few views at a time, with a mean that moves
/// (Ross et al. 2008). What a view does not show is taken from the bases as they are. Luma may have
/// all bases, chroma up to half as many; `channels` gives them out.
class IncrementalFit {
 public:
  IncrementalFit(std::size_t used_texels, std::size_t bases, int threads);

  /// `mean` is the stored mean of every used texel, these views included.
  void add(std::span<const std::vector<SeenTexel>> views, std::vector<Texel> mean);

  /// Those of all views so far.
  [[nodiscard]] std::array<Channel, 3> channels() const;

 private:
  void add_to(std::size_t channel, std::span<const std::vector<SeenTexel>> views,
              const std::vector<Texel>& mean);

  std::size_t bases_;
  int threads_;
  std::vector<Texel> mean_;  ///< after the last views
  std::vector<std::uint8_t> was_seen_;
  std::array<Factors, 3> factors_;
};

}  // namespace sheen::fitting::eigen_texture
