// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/model_file/model_file.h"
#include "fitting/texture/surface_texture.h"

namespace sheen::exporters {

/// Mean radiance over the surface: the texture of a model that has one, else its patches' means,
/// interpolated across the triangles, at three texels an edge: more would say nothing new. Texels
/// beside the charts go on as these end.
fitting::SurfaceTexture mean_texture(const fitting::Model& model);

/// What a reader that knows only this texture sees.
fitting::Model textured_model(const fitting::Model& model, const fitting::SurfaceTexture& texture);

/// What a reader that knows only one colour per vertex sees, sRGB.
fitting::Model coloured_model(const fitting::Model& model,
                              const std::vector<Eigen::Vector3f>& colours);

/// Mean length of the edges, metres.
float mean_edge(const core::Mesh& mesh);

}  // namespace sheen::exporters
