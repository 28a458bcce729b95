// SPDX-License-Identifier: MIT
#pragma once

#include "render/gl/owners.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::render::gl {

/// One stage of a program: pieces of GLSL that are read one after the other, without `#version`.
struct ShaderStage {
  GLenum kind = 0;                       ///< GL_VERTEX_SHADER, ...
  std::string name;                      ///< for error messages
  std::vector<std::string_view> pieces;  ///< must live until make_program returns
};

/// Compiles and links for GLSL 4.50 core. Throws core::Error (run_failed) with the first line of
/// the driver's log.
Program make_program(const Functions& gl, std::span<const ShaderStage> stages);

}  // namespace sheen::render::gl
