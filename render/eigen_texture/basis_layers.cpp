// SPDX-License-Identifier: MIT
#include "render/eigen_texture/basis_layers.h"

#include "core/diagnostics/error.h"
#include "render/surface/patch_shader.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sheen::render::eigen_texture {
namespace {

using fitting::eigen_texture::Channel;
using fitting::eigen_texture::EigenTexture;

constexpr std::size_t kPerLayer = 4;
constexpr GLuint kBasisUnit = 1;

/// As layers.glsl has them.
struct Layer {
  std::array<float, 4> red{}, green{}, blue{};
};
struct Header {
  std::int32_t layer_count = 0;
  std::array<std::int32_t, 3> padding{};
};

/// What luma, U and V add to R, G, B: the inverse of luma_chroma.h.
constexpr std::array<std::array<float, 3>, 3> kRgb{
    {{1, 1, 1}, {0, -0.395f, 2.033f}, {1.140f, -0.581f, 0}}};

/// A header, then the layers; one at least, so that the array is one.
gl::Buffer make_layer_buffer(const gl::Functions& gl, const std::vector<Layer>& layers) {
  const Header header{static_cast<std::int32_t>(layers.size())};
  const auto bytes = static_cast<GLsizeiptr>(layers.size() * sizeof(Layer));
  gl::Buffer buffer =
      gl::make_buffer(gl, GLsizeiptr{sizeof(Header) + sizeof(Layer)} + bytes, nullptr);
  gl.NamedBufferSubData(buffer.name(), 0, sizeof(header), &header);
  if (bytes > 0) gl.NamedBufferSubData(buffer.name(), sizeof(header), bytes, layers.data());
  return buffer;
}

std::size_t bases_of(const EigenTexture& model) {
  std::size_t count = 0;
  for (const Channel& channel : model.channels()) count += channel.bases;
  return count;
}

}  // namespace

BasisLayers::BasisLayers(const gl::Functions& gl, const EigenTexture& model)
    : gl_(gl),
      model_(model),
      mean_(gl, model.mean()),
      layer_count_((bases_of(model) + kPerLayer - 1) / kPerLayer),
      layers_(make_layer_buffer(gl, {})),
      no_layers_(make_layer_buffer(gl, {})) {
  send_bases();
}

void BasisLayers::send_bases() {
  const core::Atlas& atlas = model_.mean().atlas();
  bases_ = gl::make_texture(gl_, GL_TEXTURE_2D_ARRAY);
  // One layer at least, so that there is something to bind.
  const auto count = static_cast<GLsizei>(std::max<std::size_t>(layer_count_, 1));
  gl_.TextureStorage3D(bases_.name(), 1, GL_RGBA8_SNORM, atlas.width, atlas.height, count);
  if (gl_.GetError() == GL_OUT_OF_MEMORY) {
    throw core::Error(core::Error::Kind::run_failed,
                      std::to_string(bases_of(model_)) + " basis textures of " +
                          std::to_string(atlas.width) + " x " + std::to_string(atlas.height),
                      "need more memory than this OpenGL driver has",
                      "make the model with fewer --bases or a smaller --texture-side");
  }
  for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    gl_.TextureParameteri(bases_.name(), name, GL_LINEAR);
  }
  for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    gl_.TextureParameteri(bases_.name(), name, GL_CLAMP_TO_EDGE);
  }

  // Interleave the bases of luma, U and V, one behind the other; texels without any of the surface
  // stay the mean's.
  using FourBases = std::array<std::int8_t, kPerLayer>;
  const std::vector<std::uint32_t>& used = model_.used();
  std::vector<std::vector<FourBases>> all(static_cast<std::size_t>(count),
                                          std::vector<FourBases>(atlas.texel_count(), FourBases{}));
  std::size_t next = 0;
  for (const Channel& channel : model_.channels()) {
    for (std::size_t k = 0; k < channel.bases; ++k, ++next) {
      const std::int8_t* const row = channel.texels.data() + k * used.size();
      auto& layer = all[next / kPerLayer];
      for (std::size_t i = 0; i < used.size(); ++i) layer[used[i]][next % kPerLayer] = row[i];
    }
  }
  for (GLsizei i = 0; i < count; ++i) {
    gl_.TextureSubImage3D(bases_.name(), 0, 0, 0, i, atlas.width, atlas.height, 1, GL_RGBA, GL_BYTE,
                          all[static_cast<std::size_t>(i)].data());
  }
}

void BasisLayers::look_from(const Eigen::Vector3f& eye) {
  // What the texture gives as 1 is 127 steps of a basis, and 255 grey levels of the sum.
  constexpr float whole = 127.0f / 255.0f;
  std::vector<Layer> layers(layer_count_);
  std::size_t next = 0;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (const float coefficient : model_.coefficients(channel, eye)) {
      Layer& layer = layers[next / kPerLayer];
      const std::size_t at = next++ % kPerLayer;
      layer.red[at] = whole * coefficient * kRgb[channel][0];
      layer.green[at] = whole * coefficient * kRgb[channel][1];
      layer.blue[at] = whole * coefficient * kRgb[channel][2];
    }
  }
  layers_ = make_layer_buffer(gl_, layers);
}

void BasisLayers::bind() const {
  mean_.bind(kSurfaceTextureUnit);
  gl_.BindTextureUnit(kBasisUnit, bases_.name());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, layers_.name());
}

void BasisLayers::bind_no_layers() const {
  gl_.BindTextureUnit(kBasisUnit, bases_.name());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, no_layers_.name());
}

std::size_t BasisLayers::byte_size() const {
  return model_.mean().atlas().texel_count() * (sizeof(fitting::Texel) + kPerLayer * layer_count_);
}

}  // namespace sheen::render::eigen_texture
