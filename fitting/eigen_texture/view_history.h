// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/eigen_texture/texel_reader.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace sheen::fitting::eigen_texture {

/// What all views showed; or so much of it that memory does not grow with the views: of every texel
/// about `most_per_texel` observations (kSampledShare times as many of the texels from which the
/// views' coefficients are found), each view's as likely as any other's. Which ones is settled by a
/// hash of texel and view, so it depends on nothing else than how often the texel was seen.
class ViewHistory {
 public:
  static constexpr std::size_t kSampledShare = 8;

  /// Nothing for `most_per_texel`: all of it is kept.
  ViewHistory(std::size_t used_texels, std::optional<std::size_t> most_per_texel);

  /// Ascending slots, as TexelReader gives them. Up to an eighth more than said is held.
  void add(std::vector<SeenTexel> view);

  /// What is kept of every view, ascending slots.
  [[nodiscard]] const std::vector<std::vector<SeenTexel>>& views() const { return views_; }

 private:
  void thin(std::vector<SeenTexel>& view, std::size_t view_idx) const;

  std::optional<std::size_t> most_per_texel_;
  std::size_t sampling_step_;
  std::vector<std::uint32_t> seen_count_;  ///< [used texel]: by so many views
  std::size_t next_pass_ = 1;              ///< with so many views all are thinned again
  std::vector<std::vector<SeenTexel>> views_;
};

}  // namespace sheen::fitting::eigen_texture
