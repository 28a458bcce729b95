// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/detail/anchored_offsets.h"
#include "render/gl/owners.h"
#include "render/sparse/patch_terms.h"

#include <cstddef>
#include <memory>

namespace sheen::render::detail {

/// Offsets at anchors on the GPU, as detail.glsl reads them.
class AnchorUpload {
 public:
  explicit AnchorUpload(const gl::Functions& gl);

  /// Sends `anchors` (null: none) unless they are there. Returns the bytes sent.
  std::size_t show(const std::shared_ptr<const fitting::detail::AnchoredOffsets>& anchors);

  [[nodiscard]] bool has_any() const { return shown_ != nullptr; }

  void bind() const;

 private:
  const gl::Functions& gl_;
  std::shared_ptr<const fitting::detail::AnchoredOffsets> shown_;
  std::unique_ptr<sparse::PatchTerms> terms_;
  gl::Buffer buffer_;
  gl::Texture texture_;
};

}  // namespace sheen::render::detail
