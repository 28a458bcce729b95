// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "render/context/context.h"

#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>
#include <memory>
#include <string>

namespace sheen::render {
namespace {

constexpr const char* kLibrary = "libOSMesa.so.8";

core::Error failure(const std::string& fault) {
  return {core::Error::Kind::run_failed, kLibrary, fault, "install the package libosmesa6"};
}

struct LibraryCloser {
  void operator()(void* library) const { dlclose(library); }
};
using Library = std::unique_ptr<void, LibraryCloser>;

/// Opened at run time and with local symbols: linked directly, its gl* symbols would take the place
/// of the window system's OpenGL. Never unloaded, since LLVM leaves hooks for the end of the
/// process.
Library open_library() {
  Library library(dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE));
  if (!library) throw failure("cannot be loaded");
  return library;
}

template <typename Pointer>
Pointer symbol(const Library& library, const char* name) {
  void* const address = dlsym(library.get(), name);
  if (address == nullptr) throw failure(std::string("lacks ") + name);
  return reinterpret_cast<Pointer>(address);
}

class OsmesaContext final : public Context {
 public:
  OsmesaContext()
      : library_(open_library()),
        make_current_(symbol<decltype(make_current_)>(library_, "OSMesaMakeCurrent")),
        get_proc_address_(symbol<decltype(get_proc_address_)>(library_, "OSMesaGetProcAddress")),
        context_(nullptr, symbol<DestroyFunction>(library_, "OSMesaDestroyContext")) {
    constexpr std::array attributes{OSMESA_FORMAT,
                                    OSMESA_RGBA,
                                    OSMESA_PROFILE,
                                    OSMESA_CORE_PROFILE,
                                    OSMESA_CONTEXT_MAJOR_VERSION,
                                    4,
                                    OSMESA_CONTEXT_MINOR_VERSION,
                                    5,
                                    0};
    const auto create =
        symbol<decltype(&OSMesaCreateContextAttribs)>(library_, "OSMesaCreateContextAttribs");
    context_.reset(create(attributes.data(), nullptr));
    if (!context_) throw failure("does not offer OpenGL 4.5 core");
    make_current();
  }

  void make_current() override {
    if (make_current_(context_.get(), image_.data(), GL_UNSIGNED_BYTE, kSide, kSide) != GL_TRUE) {
      throw failure("cannot make its context current");
    }
  }

  [[nodiscard]] Function resolve(const char* name) const override {
    return get_proc_address_(name);
  }

 private:
  using DestroyFunction = decltype(&OSMesaDestroyContext);
  static constexpr int kSide = 16;  // OSMesa wants an image; we draw into framebuffer objects

  std::array<GLubyte, kSide * kSide * 4> image_{};
  Library library_;
  decltype(&OSMesaMakeCurrent) make_current_;
  decltype(&OSMesaGetProcAddress) get_proc_address_;
  std::unique_ptr<osmesa_context, DestroyFunction> context_;
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context() {
  return std::make_unique<OsmesaContext>();
}

}  // namespace sheen::render
