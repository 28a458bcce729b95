// SPDX-License-Identifier: MIT
#pragma once

#include "render/gl/functions.h"

#include <utility>

namespace sheen::render::gl {

/// Owns one OpenGL name and deletes it; moving leaves nothing behind to delete. The table and the
/// context must outlive it, the context being current when it dies.
template <typename Kind>
class Owner {
 public:
  Owner() = default;
  Owner(const Functions& gl, GLuint name) : gl_(&gl), name_(name) {}
  ~Owner() { release(); }
  Owner(const Owner&) = delete;
  Owner& operator=(const Owner&) = delete;
  Owner(Owner&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
  Owner& operator=(Owner&& other) noexcept {
    if (this != &other) {
      release();
      gl_ = other.gl_;
      name_ = std::exchange(other.name_, 0);
    }
    return *this;
  }

  /// 0 when it owns nothing.
  [[nodiscard]] GLuint name() const { return name_; }

 private:
  void release() noexcept {
    if (name_ != 0) Kind::destroy(*gl_, name_);
    name_ = 0;
  }

  const Functions* gl_ = nullptr;
  GLuint name_ = 0;
};

struct BufferKind {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteBuffers(1, &name); }
};
struct TextureKind {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteTextures(1, &name); }
};
struct FramebufferKind {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteFramebuffers(1, &name); }
};
struct VertexArrayKind {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteVertexArrays(1, &name); }
};
struct ShaderKind {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteShader(name); }
};
struct ProgramKind {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteProgram(name); }
};

using Buffer = Owner<BufferKind>;
using Texture = Owner<TextureKind>;
using Framebuffer = Owner<FramebufferKind>;
using VertexArray = Owner<VertexArrayKind>;
using Shader = Owner<ShaderKind>;
using Program = Owner<ProgramKind>;

/// A buffer of fixed size, > 0 bytes; `data` may be null. Refilled with NamedBufferSubData.
inline Buffer make_buffer(const Functions& gl, GLsizeiptr bytes, const void* data) {
  GLuint name = 0;
  gl.CreateBuffers(1, &name);
  Buffer buffer(gl, name);
  gl.NamedBufferStorage(name, bytes, data, GL_DYNAMIC_STORAGE_BIT);
  return buffer;
}

/// `target` is GL_TEXTURE_2D, GL_TEXTURE_BUFFER, ...
inline Texture make_texture(const Functions& gl, GLenum target) {
  GLuint name = 0;
  gl.CreateTextures(target, 1, &name);
  return {gl, name};
}

inline Framebuffer make_framebuffer(const Functions& gl) {
  GLuint name = 0;
  gl.CreateFramebuffers(1, &name);
  return {gl, name};
}

inline VertexArray make_vertex_array(const Functions& gl) {
  GLuint name = 0;
  gl.CreateVertexArrays(1, &name);
  return {gl, name};
}

}  // namespace sheen::render::gl
