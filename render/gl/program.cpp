// SPDX-License-Identifier: MIT
#include "render/gl/program.h"

#include "core/diagnostics/error.h"

#include <algorithm>

namespace sheen::render::gl {
namespace {

std::string first_line(const std::string& log) {
  // NOLINTNEXTLINE(readability-redundant-string-cstr)
  const std::string text(log.c_str());  // the driver counts the closing zero
  return text.empty() ? "refused without a log" : text.substr(0, text.find('\n'));
}

core::Error failure(const std::string& subject, const std::string& log) {
  return {core::Error::Kind::run_failed, "shader " + subject, first_line(log),
          "use a driver with OpenGL 4.5 core"};
}

Shader compile(const Functions& gl, const ShaderStage& stage) {
  // Put the version in front of the pieces.
  std::vector<std::string_view> pieces{"#version 450 core\n"};
  pieces.insert(pieces.end(), stage.pieces.begin(), stage.pieces.end());
  std::vector<const GLchar*> texts;
  std::vector<GLint> lengths;
  for (const std::string_view piece : pieces) {
    texts.push_back(piece.data());
    lengths.push_back(static_cast<GLint>(piece.size()));
  }

  // Compile, and say what the driver says.
  Shader shader(gl, gl.CreateShader(stage.kind));
  gl.ShaderSource(shader.name(), static_cast<GLsizei>(texts.size()), texts.data(), lengths.data());
  gl.CompileShader(shader.name());
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  GLint length = 0;
  gl.GetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 0)) + 1, '\0');
  gl.GetShaderInfoLog(shader.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw failure(stage.name, log);
}

}  // namespace

Program make_program(const Functions& gl, std::span<const ShaderStage> stages) {
  // Compile every stage.
  Program program(gl, gl.CreateProgram());
  std::vector<Shader> shaders;
  std::string names;
  for (const ShaderStage& stage : stages) {
    shaders.push_back(compile(gl, stage));
    gl.AttachShader(program.name(), shaders.back().name());
    names += (names.empty() ? "" : " + ") + stage.name;
  }

  // Link them.
  gl.LinkProgram(program.name());
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program.name(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  GLint length = 0;
  gl.GetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 0)) + 1, '\0');
  gl.GetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw failure(names, log);
}

}  // namespace sheen::render::gl
