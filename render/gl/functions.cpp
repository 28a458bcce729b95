// SPDX-License-Identifier: MIT
#include "render/gl/functions.h"

#include "core/diagnostics/error.h"

#include <algorithm>
#include <array>
#include <string_view>

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

bool is_software(const Functions& gl) {
  const auto* const bytes = gl.GetString(GL_RENDERER);
  const std::string_view name = bytes ? reinterpret_cast<const char*>(bytes) : "";
  return std::ranges::any_of(
      std::array<std::string_view, 3>{"llvmpipe", "softpipe", "swrast"},
      [&](std::string_view one) { return name.find(one) != std::string_view::npos; });
}

}  // namespace sheen::render::gl
