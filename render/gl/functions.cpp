// SPDX-License-Identifier: MIT
#include "render/gl/functions.h"

#include "core/diagnostics/error.h"

namespace sheen::render::gl {
namespace {

template <typename Pointer>
void load(const Context& context, const char* name, Pointer& pointer) {
  pointer = reinterpret_cast<Pointer>(context.resolve(name));
  if (pointer == nullptr) {
    throw core::Error(core::Error::Kind::run_failed, name, "is not offered by this OpenGL driver",
                      "use a driver with OpenGL 4.5 core");
  }
}

}  // namespace

Functions load_functions(Context& context) {
  context.make_current();
  Functions gl;
#define SHEEN_GL_LOAD(type, name) load(context, "gl" #name, gl.name);
  SHEEN_GL_FUNCTIONS(SHEEN_GL_LOAD)
#undef SHEEN_GL_LOAD
  return gl;
}

GLint integer_limit(const Functions& gl, GLenum name) {
  GLint value = 0;
  gl.GetIntegerv(name, &value);
  return value;
}

}  // namespace sheen::render::gl
