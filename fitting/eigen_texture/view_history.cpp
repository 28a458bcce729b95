// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/view_history.h"

#include "fitting/eigen_texture/deviation.h"

#include <utility>

namespace sheen::fitting::eigen_texture {
namespace {

/// Evenly distributed over all 32-bit numbers (the finaliser of SplitMix64, Steele et al. 2014).
std::uint32_t hash(std::uint64_t slot, std::uint64_t view_idx) {
  std::uint64_t bits = (view_idx << 32 | slot) + 0x9e3779b97f4a7c15;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
  return static_cast<std::uint32_t>((bits ^ (bits >> 31)) >> 32);
}

}  // namespace

ViewHistory::ViewHistory(std::size_t used_texels, std::optional<std::size_t> most_per_texel)
    : most_per_texel_(most_per_texel),
      sampling_step_(sampling_step(used_texels)),
      seen_count_(most_per_texel ? used_texels : 0) {}

void ViewHistory::add(std::vector<SeenTexel> view) {
  views_.push_back(std::move(view));
  if (!most_per_texel_) return;
  for (const SeenTexel& seen : views_.back()) ++seen_count_[seen.slot];
  thin(views_.back(), views_.size() - 1);
  if (views_.size() < next_pass_) return;
  for (std::size_t i = 0; i < views_.size(); ++i) thin(views_[i], i);
  next_pass_ = views_.size() + views_.size() / 8 + 1;
}

// An observation stays while its hash is below most / seen of all hashes.
void ViewHistory::thin(std::vector<SeenTexel>& view, std::size_t view_idx) const {
  const auto goes = [&](const SeenTexel& seen) {
    const std::uint64_t most =
        *most_per_texel_ * (seen.slot % sampling_step_ == 0 ? kSampledShare : 1);
    return std::uint64_t{seen_count_[seen.slot]} * hash(seen.slot, view_idx) >= most << 32;
  };
  if (std::erase_if(view, goes) > view.capacity() / 8) view.shrink_to_fit();
}

}  // namespace sheen::fitting::eigen_texture
