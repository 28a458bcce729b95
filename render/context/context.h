// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

namespace sheen::render {

/// An OpenGL 4.5 core context. Contexts belong to whichever thread made them current last; objects
/// live and die while their context is current.
class Context {
 public:
  using Function = void (*)();
  virtual ~Context() = default;
  virtual void make_current() = 0;
  [[nodiscard]] virtual Function resolve(const char* name) const = 0;
};

/// Off screen in software (OSMesa), made current. Throws core::Error (run_failed) when the library
/// or the version is missing.
std::unique_ptr<Context> make_osmesa_context();

enum class EglDevice { gpu, software };

/// Off screen without a window system, on the first EGL device of this kind that offers OpenGL 4.5
/// core; made current. Unlike others it stays with the thread that made it: `make_current` throws
/// on another one. Throws core::Error (run_failed) when there is none.
std::unique_ptr<Context> make_egl_context(EglDevice kind);

/// Off screen on a GPU where one is at hand, else OSMesa; for use on one thread. Software EGL is
/// never chosen: it draws with the same rasteriser as OSMesa.
std::unique_ptr<Context> make_context();

}  // namespace sheen::render
