// SPDX-License-Identifier: MIT
#include "render/detail/detail_patch_shader.h"

#include "fitting/detail/detail_light_field.h"
#include "render/detail/anchor_upload.h"
#include "render/detail/texture_upload.h"
#include "render/shaders/shader_text.h"
#include "render/sparse/sparse_patch_shader.h"

#include <algorithm>
#include <string>
#include <vector>

namespace sheen::render::detail {
namespace {

using fitting::detail::DetailLightField;

class DetailPatchShader final : public PatchShader {
 public:
  DetailPatchShader(const gl::Functions& gl, const DetailLightField& model)
      : model_(model),
        offsets_(sparse::make_patch_shader(gl, model.offsets())),
        anchors_(gl),
        texture_(gl, model.texture()) {
    anchors_.show(model.anchors());
  }

  [[nodiscard]] std::string glsl() const override {
    return offsets_->glsl() + std::string(shader_text("detail/detail.glsl"));
  }
  [[nodiscard]] bool adds_between_patches() const override { return anchors_.has_any(); }
  [[nodiscard]] const core::Atlas* atlas() const override { return &model_.texture().atlas(); }

  std::size_t upload(std::span<const std::uint32_t> elements) override {
    const auto first_page = static_cast<std::uint32_t>(model_.patch_count());
    const auto pages = std::ranges::lower_bound(elements, first_page);
    const auto patches = static_cast<std::size_t>(pages - elements.begin());
    std::size_t bytes = offsets_->upload(elements.first(patches));
    bytes += anchors_.show(model_.anchors());
    for (const std::uint32_t element : elements.subspan(patches)) {
      bytes += texture_.send(element - first_page);
    }
    return bytes;
  }

  void bind() const override {
    offsets_->bind();
    anchors_.bind();
    texture_.bind(kSurfaceTextureUnit);
  }

 private:
  const DetailLightField& model_;
  std::unique_ptr<PatchShader> offsets_;
  AnchorUpload anchors_;
  TextureUpload texture_;
};

}  // namespace

std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl,
                                               const fitting::PatchLightField& light_field) {
  return make_shader_of<DetailPatchShader, DetailLightField>(gl, light_field);
}

}  // namespace sheen::render::detail
