// SPDX-License-Identifier: MIT
#include "render/detail/anchor_upload.h"

#include "core/diagnostics/error.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace sheen::render::detail {
namespace {

using fitting::detail::AnchoredOffsets;
using fitting::detail::AskedDirection;
using fitting::detail::CornerWeights;
using Texel = std::array<float, 4>;

/// Numbers of texels are floats, exact up to here.
constexpr std::size_t kMostTexels = std::size_t{1} << 24;

/// As detail.glsl reads them.
std::vector<Texel> blend_texels(const AnchoredOffsets& anchors, std::size_t texels_per_anchor) {
  const core::Mesh& mesh = anchors.mesh();
  std::vector<Texel> triangles, lists;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto first = static_cast<float>(lists.size());
    for (const CornerWeights& blend : anchors.blends(t)) {
      if (anchors.models().term_count(blend.anchor) == 1) continue;
      lists.push_back(
          {static_cast<float>(blend.anchor), blend.weight[0], blend.weight[1], blend.weight[2]});
    }
    const std::array<float, 3> numbers{first, static_cast<float>(lists.size()), 0.0f};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3f& p =
          mesh.positions[mesh.triangles[t][static_cast<Eigen::Index>(corner)]];
      triangles.push_back({p.x(), p.y(), p.z(), numbers[corner]});
    }
  }
  const float side = anchors.asked() == AskedDirection::mirrored ? -1.0f : 1.0f;
  std::vector<Texel> texels{{side, static_cast<float>(mesh.triangles.size()),
                             static_cast<float>(lists.size()),
                             static_cast<float>(texels_per_anchor)}};
  texels.insert(texels.end(), triangles.begin(), triangles.end());
  texels.insert(texels.end(), lists.begin(), lists.end());
  for (std::size_t anchor = 0; anchor < anchors.models().patch_count(); ++anchor) {
    const Eigen::Vector3f& n = anchors.frame(anchor).normal;
    texels.push_back({n.x(), n.y(), n.z(), 0.0f});
  }
  return texels;
}

}  // namespace

AnchorUpload::AnchorUpload(const gl::Functions& gl) : gl_(gl) {
  show(nullptr);
}

std::size_t AnchorUpload::show(const std::shared_ptr<const AnchoredOffsets>& anchors) {
  if (texture_.name() != 0 && anchors == shown_) return 0;
  auto terms = anchors ? std::make_unique<sparse::PatchTerms>(gl_, anchors->models()) : nullptr;
  const std::vector<Texel> texels =
      anchors ? blend_texels(*anchors, terms->texels_per_patch()) : std::vector<Texel>(1);
  const std::size_t limit = std::min(
      kMostTexels, static_cast<std::size_t>(gl::integer_limit(gl_, GL_MAX_TEXTURE_BUFFER_SIZE)));
  if (texels.size() > limit) {
    throw core::Error(core::Error::Kind::run_failed,
                      "model of " + std::to_string(anchors->models().patch_count()) + " anchors",
                      "needs " + std::to_string(texels.size()) +
                          " texels, this OpenGL driver and program hold " + std::to_string(limit),
                      "use a coarser mesh");
  }
  const std::size_t bytes = texels.size() * sizeof(Texel);
  buffer_ = gl::make_buffer(gl_, static_cast<GLsizeiptr>(bytes), texels.data());
  texture_ = gl::make_texture(gl_, GL_TEXTURE_BUFFER);
  gl_.TextureBuffer(texture_.name(), GL_RGBA32F, buffer_.name());
  terms_ = std::move(terms);
  shown_ = anchors;
  return bytes;
}

void AnchorUpload::bind() const {
  if (terms_) terms_->bind(2);
  gl_.BindTextureUnit(3, texture_.name());
}

}  // namespace sheen::render::detail
