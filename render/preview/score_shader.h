// SPDX-License-Identifier: MIT
#pragma once

#include "render/surface/patch_shader.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace sheen::render {

/// Colours of the scores 0, 1/2 and 1, sRGB; linear in between.
struct ScorePalette {
  Eigen::Vector3f low, middle, high;
};

/// Paints a number in [0, 1] per patch, limited to it. `scores` has an entry per patch, outlives
/// the shader and is read by `upload` only.
std::unique_ptr<PatchShader> make_score_shader(const gl::Functions& gl,
                                               const std::vector<float>& scores,
                                               const ScorePalette& palette);

}  // namespace sheen::render
