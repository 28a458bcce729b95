// SPDX-License-Identifier: MIT
#include "exporters/surface/mean_texture.h"

#include "fitting/detail/detail_light_field.h"
#include "fitting/mean/mean_light_field.h"
#include "fitting/patch_light_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace sheen::exporters {
namespace {

using fitting::SurfaceTexture;

constexpr float kTexelsPerEdge = 3.0f;
constexpr std::size_t kMostTexels = std::size_t{1} << 24;

struct Painted {
  SurfaceTexture& texture;
  std::vector<float> distance;  ///< of every texel to the triangle that coloured it, texels
};

/// Weights of the corners at the point of a triangle nearest to `p`: exact inside, and near enough
/// within the gutter. Nothing for triangles without area.
std::optional<Eigen::Vector3f> weights_at(const std::array<Eigen::Vector2f, 3>& corner,
                                          const Eigen::Vector2f& p) {
  const Eigen::Vector2f a = corner[1] - corner[0];
  const Eigen::Vector2f b = corner[2] - corner[0];
  const float area = a.x() * b.y() - a.y() * b.x();
  if (!(std::abs(area) > 1e-6f)) return std::nullopt;
  const Eigen::Vector2f r = p - corner[0];
  const float second = (r.x() * b.y() - r.y() * b.x()) / area;
  const float third = (a.x() * r.y() - a.y() * r.x()) / area;
  const Eigen::Vector3f weights = Eigen::Vector3f(1 - second - third, second, third).cwiseMax(0.0f);
  return Eigen::Vector3f(weights / weights.sum());
}

void paint(const std::array<Eigen::Vector2f, 3>& corner,
           const std::array<Eigen::Vector3f, 3>& colour, Painted& painted) {
  const auto gutter = static_cast<float>(core::kGutterTexels);
  const core::Atlas& atlas = painted.texture.atlas();
  const Eigen::Vector2f lower = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]).array() - gutter;
  const Eigen::Vector2f upper = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]).array() + gutter;
  const int left = std::max(0, static_cast<int>(std::floor(lower.x())));
  const int top = std::max(0, static_cast<int>(std::floor(lower.y())));
  const int right = std::min(atlas.width, static_cast<int>(std::ceil(upper.x())));
  const int bottom = std::min(atlas.height, static_cast<int>(std::ceil(upper.y())));
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const Eigen::Vector2f centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const auto weights = weights_at(corner, centre);
      if (!weights) return;
      const Eigen::Vector2f nearest =
          (*weights)[0] * corner[0] + (*weights)[1] * corner[1] + (*weights)[2] * corner[2];
      const float distance = (nearest - centre).norm();
      const auto texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(atlas.width) +
                         static_cast<std::size_t>(x);
      if (distance > gutter || distance >= painted.distance[texel]) continue;
      painted.distance[texel] = distance;
      const Eigen::Vector3f value =
          (*weights)[0] * colour[0] + (*weights)[1] * colour[1] + (*weights)[2] * colour[2];
      for (int channel = 0; channel < 3; ++channel) {
        painted.texture.texels()[texel][static_cast<std::size_t>(channel)] =
            static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value[channel], 0.0f, 1.0f)));
      }
    }
  }
}

SurfaceTexture baked(const core::Mesh& mesh, const std::vector<Eigen::Vector3f>& colours) {
  SurfaceTexture texture(core::make_atlas(mesh, mean_edge(mesh) / kTexelsPerEdge, kMostTexels));
  Painted painted{
      texture, std::vector<float>(texture.texels().size(), std::numeric_limits<float>::infinity())};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Eigen::Vector2f, 3> corner;
    std::array<Eigen::Vector3f, 3> colour;
    for (std::size_t c = 0; c < 3; ++c) {
      corner[c] = texture.atlas().place(t, c);
      colour[c] = colours[mesh.triangles[t][static_cast<Eigen::Index>(c)]];
    }
    paint(corner, colour, painted);
  }
  return texture;
}

}  // namespace

float mean_edge(const core::Mesh& mesh) {
  double sum = 0;
  for (const auto& triangle : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3f edge =
          mesh.positions[triangle[c]] - mesh.positions[triangle[(c + 1) % 3]];
      sum += static_cast<double>(edge.norm());
    }
  }
  return static_cast<float>(sum / (3.0 * static_cast<double>(mesh.triangles.size())));
}

SurfaceTexture mean_texture(const fitting::Model& model) {
  const auto* const patches = fitting::as_patches(*model.light_field);
  const SurfaceTexture* const own =
      patches != nullptr ? patches->texture_between_patches() : nullptr;
  return own != nullptr ? *own : baked(model.mesh, model.light_field->vertex_colours(model.mesh));
}

fitting::Model textured_model(const fitting::Model& model, const SurfaceTexture& texture) {
  auto light_field =
      std::make_unique<fitting::detail::DetailLightField>(model.mesh, texture.atlas());
  light_field->texture() = texture;
  return {model.mesh, std::move(light_field), {}};
}

fitting::Model coloured_model(const fitting::Model& model,
                              const std::vector<Eigen::Vector3f>& colours) {
  auto means = std::make_unique<fitting::mean::MeanLightField>(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i) means->store(i, colours[i], true);
  return {model.mesh, std::move(means), {}};
}

}  // namespace sheen::exporters
