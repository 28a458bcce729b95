// SPDX-License-Identifier: MIT
#include "render/context/context.h"
#include "render/context/runtime_library.h"

#include <GL/osmesa.h>

#include <array>
#include <memory>

namespace sheen::render {
namespace {

class OsmesaContext final : public Context {
 public:
  OsmesaContext()
      : make_current_(library_.symbol<decltype(make_current_)>("OSMesaMakeCurrent")),
        get_proc_address_(library_.symbol<decltype(get_proc_address_)>("OSMesaGetProcAddress")),
        context_(nullptr, library_.symbol<DestroyFunction>("OSMesaDestroyContext")) {
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
        library_.symbol<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
    context_.reset(create(attributes.data(), nullptr));
    if (!context_) throw library_.failure("does not offer OpenGL 4.5 core");
    make_current();
  }

  void make_current() override {
    if (make_current_(context_.get(), image_.data(), GL_UNSIGNED_BYTE, kSide, kSide) != GL_TRUE) {
      throw library_.failure("cannot make its context current");
    }
  }

  [[nodiscard]] Function resolve(const char* name) const override {
    return get_proc_address_(name);
  }

 private:
  using DestroyFunction = decltype(&OSMesaDestroyContext);
  static constexpr int kSide = 16;  // OSMesa wants an image; we draw into framebuffer objects

  std::array<GLubyte, kSide * kSide * 4> image_{};
  RuntimeLibrary library_{"libOSMesa.so.8", "install the package libosmesa6"};
  decltype(&OSMesaMakeCurrent) make_current_;
  decltype(&OSMesaGetProcAddress) get_proc_address_;
  std::unique_ptr<osmesa_context, DestroyFunction> context_;
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context() {
  return std::make_unique<OsmesaContext>();
}

}  // namespace sheen::render
