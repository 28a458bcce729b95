// SPDX-License-Identifier: MIT
#pragma once

#include "render/surface/patch_shader.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace sheen::render {

/// Score of a patch that cannot be on the scale: nobody has seen it.
inline constexpr float kUnseenScore = -1.0f;

/// Colours of the scores 0, 1/2 and 1, sRGB; linear in between. Patches that nobody has seen have a
/// colour of their own.
struct ScorePalette {
  Eigen::Vector3f low, middle, high, unseen;
};

/// Paints a number in [0, 1] per patch, limited to it, or kUnseenScore. `scores` has an entry per
/// patch, outlives the shader and is read by `upload` only.
std::unique_ptr<PatchShader> make_score_shader(const gl::Functions& gl,
                                               const std::vector<float>& scores,
                                               const ScorePalette& palette);

}  // namespace sheen::render
