// SPDX-License-Identifier: MIT
#pragma once

#include "core/diagnostics/error.h"

#include <dlfcn.h>

#include <string>

namespace sheen::render {

/// A library of OpenGL, opened at run time and with local symbols: linked directly, the gl* symbols
/// of one would take the place of another's, and machines without it could run nothing. Never
/// unloaded, since drivers and LLVM leave hooks for the end of the process.
class RuntimeLibrary {
 public:
  /// `remedy` says what to install. Throws core::Error (run_failed) when it is not there.
  RuntimeLibrary(const char* name, const char* remedy)
      : name_(name), remedy_(remedy), handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) {
    if (handle_ == nullptr) throw failure("cannot be loaded");
  }

  template <typename Pointer>
  [[nodiscard]] Pointer symbol(const char* name) const {
    return found(reinterpret_cast<Pointer>(dlsym(handle_, name)), name);
  }

  /// `pointer`, unless it is null.
  template <typename Pointer>
  [[nodiscard]] Pointer found(Pointer pointer, const char* name) const {
    if (pointer == nullptr) throw failure(std::string("lacks ") + name);
    return pointer;
  }

  [[nodiscard]] core::Error failure(const std::string& fault) const {
    return {core::Error::Kind::run_failed, name_, fault, remedy_};
  }

 private:
  const char* name_;
  const char* remedy_;
  void* handle_;
};

}  // namespace sheen::render
