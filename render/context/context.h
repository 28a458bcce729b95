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

}  // namespace sheen::render
