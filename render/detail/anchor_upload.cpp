// SPDX-License-Identifier: MIT
#include "render/detail/anchor_upload.h"

#include "core/diagnostics/error.h"

#include <array>
#include <string>
#include <vector>

namespace sheen::render::detail {
namespace {

using fitting::detail::AnchorBlend;
using fitting::detail::AnchoredOffsets;
using fitting::detail::AskedDirection;
using Texel = std::array<float, 4>;

/// Of every vertex its normal, with 1 or -1 for mirrored, its anchors and their weights; then every
/// anchor's normal.
std::vector<Texel> blend_texels(const AnchoredOffsets& anchors) {
  const float side = anchors.asked() == AskedDirection::mirrored ? -1.0f : 1.0f;
  std::vector<Texel> texels;
  for (std::size_t vertex = 0; vertex < anchors.blends().size(); ++vertex) {
    const Eigen::Vector3f& n = anchors.normal(vertex);
    const AnchorBlend& blend = anchors.blends()[vertex];
    texels.push_back({n.x(), n.y(), n.z(), side});
    Texel numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = static_cast<float>(blend.anchor[i]);  // exact below 2^24
    }
    texels.push_back(numbers);
    texels.push_back(blend.weight);
  }
  for (const std::uint32_t vertex : anchors.layout().vertices) {
    const Eigen::Vector3f& n = anchors.normal(vertex);
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
  const std::vector<Texel> texels = anchors ? blend_texels(*anchors) : std::vector<Texel>(1);
  const auto limit = static_cast<std::size_t>(gl::integer_limit(gl_, GL_MAX_TEXTURE_BUFFER_SIZE));
  if (texels.size() > limit) {
    throw core::Error(core::Error::Kind::run_failed,
                      "model of " + std::to_string(anchors->layout().vertices.size()) + " anchors",
                      "needs " + std::to_string(texels.size()) +
                          " texels, this OpenGL driver holds " + std::to_string(limit),
                      "use a coarser mesh");
  }
  const std::size_t bytes = texels.size() * sizeof(Texel);
  buffer_ = gl::make_buffer(gl_, static_cast<GLsizeiptr>(bytes), texels.data());
  texture_ = gl::make_texture(gl_, GL_TEXTURE_BUFFER);
  gl_.TextureBuffer(texture_.name(), GL_RGBA32F, buffer_.name());
  terms_ = anchors ? std::make_unique<sparse::PatchTerms>(gl_, anchors->models()) : nullptr;
  shown_ = anchors;
  return bytes;
}

void AnchorUpload::bind() const {
  if (terms_) terms_->bind(2);
  gl_.BindTextureUnit(3, texture_.name());
}

}  // namespace sheen::render::detail
