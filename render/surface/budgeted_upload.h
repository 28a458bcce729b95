// SPDX-License-Identifier: MIT
#pragma once

#include "render/surface/patch_shader.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::render {

/// Spreads the upload of changed patches over several redraws, so that a burst of changes never
/// stops the picture: what does not fit a redraw's budget waits for the next. The newest changes go
/// first, the others in turn, so that none waits for ever.
class BudgetedUpload {
 public:
  /// `shader` must outlive this.
  BudgetedUpload(PatchShader& shader, std::size_t patch_count);

  /// Notes changed patches (ascending, no repeats). A patch that waits already is sent once, with
  /// what it holds by then.
  void add(std::span<const std::uint32_t> patches);

  /// Sends what waits until `budget_bytes` are used up; the last piece may exceed it by up to 64
  /// patches, or by a whole model where a representation needs a larger buffer. The context is
  /// current. Returns the bytes handed to OpenGL.
  std::size_t send(std::size_t budget_bytes);

  /// Patches that wait.
  [[nodiscard]] std::size_t waiting() const { return waiting_; }

 private:
  void take_newest();
  void take_next();
  void take(std::uint32_t patch_idx);

  PatchShader& shader_;
  std::vector<std::uint8_t> waits_;    // one flag per patch
  std::size_t waiting_ = 0;            // flags that are set
  std::vector<std::uint32_t> newest_;  // the last update
  std::size_t newest_done_ = 0;        // of these
  std::uint32_t turn_ = 0;             // patch at which the others go on
  std::vector<std::uint32_t> piece_;
};

}  // namespace sheen::render
