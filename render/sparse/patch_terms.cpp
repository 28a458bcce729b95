// SPDX-License-Identifier: MIT
#include "render/sparse/patch_terms.h"

#include <algorithm>

namespace sheen::render::sparse {
namespace {

using fitting::sparse::kLinearBase;
using fitting::sparse::PatchModel;

// As sparse.glsl reads them; sums of them are exact in a half.
constexpr float kLinearFlag = 32.0f;
constexpr float kObservedFlag = 64.0f;
static_assert(fitting::kUnseenWeight == 1.0f / 1024.0f, "sparse.glsl says so too");

// Room grows in steps of this many texels, so that a growing model is not sent anew for each RBF.
constexpr std::size_t kTexelStep = 4;
constexpr std::size_t kMostTexels = kLinearBase + fitting::sparse::kMaxRbfs;

void write_texels(const PatchModel& patch, bool observed, std::span<Eigen::half> texels) {
  for (std::size_t term = 0; term < patch.term_count(); ++term) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      texels[4 * term + channel] =
          Eigen::half(patch.coefficient[term][static_cast<Eigen::Index>(channel)]);
    }
    const bool is_rbf = term >= patch.base_terms;
    texels[4 * term + 3] =
        Eigen::half(is_rbf ? static_cast<float>(patch.atom[term - patch.base_terms]) : 0.0f);
  }
  texels[3] = Eigen::half(static_cast<float>(patch.rbf_count) +
                          (patch.base_terms == kLinearBase ? kLinearFlag : 0.0f) +
                          (observed ? kObservedFlag : 0.0f));
  std::ranges::fill(texels.subspan(4 * patch.term_count()), Eigen::half(0.0f));
}

}  // namespace

PatchTerms::PatchTerms(const gl::Functions& gl, const fitting::sparse::LightFieldModel& model)
    : gl_(gl), model_(model), all_(all_patches(model.patch_count())) {
  upload(all_);
}

// Returns whether the buffer is a new one.
bool PatchTerms::make_room(std::span<const std::uint32_t> patches) {
  std::size_t needed = 1;
  for (const std::uint32_t patch : patches) needed = std::max(needed, model_.term_count(patch));
  if (needed <= texels_per_patch_) return false;
  // A matte model stays at one texel; a growing one gets a little ahead of its need.
  const std::size_t rounded = (needed + kTexelStep - 1) / kTexelStep * kTexelStep;
  const std::size_t texels = needed == 1 ? 1 : std::min(rounded, kMostTexels);
  buffer_ = std::make_unique<PatchBuffer>(gl_, model_.patch_count(), texels);
  texels_per_patch_ = texels;
  return true;
}

std::size_t PatchTerms::send(std::span<const std::uint32_t> patches) {
  return buffer_->upload(patches, [this](std::size_t patch_idx, std::span<Eigen::half> texels) {
    write_texels(model_.patch(patch_idx), model_.observed()[patch_idx] != 0, texels);
  });
}

}  // namespace sheen::render::sparse
