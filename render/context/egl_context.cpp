// SPDX-License-Identifier: MIT
#include "render/context/context.h"
#include "render/context/runtime_library.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace sheen::render {
namespace {

/// The entry points this file calls.
struct Egl {
  RuntimeLibrary library{"libEGL.so.1", "install the package libegl1 and a driver with OpenGL 4.5"};
  decltype(&eglGetProcAddress) get_proc_address =
      library.symbol<decltype(&eglGetProcAddress)>("eglGetProcAddress");
  decltype(&eglInitialize) initialize = library.symbol<decltype(&eglInitialize)>("eglInitialize");
  decltype(&eglTerminate) terminate = library.symbol<decltype(&eglTerminate)>("eglTerminate");
  decltype(&eglBindAPI) bind_api = library.symbol<decltype(&eglBindAPI)>("eglBindAPI");
  decltype(&eglChooseConfig) choose_config =
      library.symbol<decltype(&eglChooseConfig)>("eglChooseConfig");
  decltype(&eglCreateContext) create_context =
      library.symbol<decltype(&eglCreateContext)>("eglCreateContext");
  decltype(&eglDestroyContext) destroy_context =
      library.symbol<decltype(&eglDestroyContext)>("eglDestroyContext");
  decltype(&eglMakeCurrent) make_current =
      library.symbol<decltype(&eglMakeCurrent)>("eglMakeCurrent");
  PFNEGLQUERYDEVICESEXTPROC query_devices =
      extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string =
      extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display =
      extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");

 private:
  template <typename Pointer>
  [[nodiscard]] Pointer extension(const char* name) const {
    return library.found(reinterpret_cast<Pointer>(get_proc_address(name)), name);
  }
};

/// Mesa's rasteriser announces itself as a device.
bool is_software(const Egl& egl, EGLDeviceEXT device) {
  const char* const extensions = egl.query_device_string(device, EGL_EXTENSIONS);
  return extensions == nullptr ||
         std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos;
}

std::vector<EGLDeviceEXT> devices_of(const Egl& egl, EglDevice kind) {
  std::array<EGLDeviceEXT, 16> found;
  EGLint count = 0;
  if (egl.query_devices(static_cast<EGLint>(found.size()), found.data(), &count) != EGL_TRUE) {
    count = 0;
  }
  std::vector<EGLDeviceEXT> wanted;
  for (EGLint i = 0; i < count; ++i) {
    const EGLDeviceEXT device = found[static_cast<std::size_t>(i)];
    if (is_software(egl, device) == (kind == EglDevice::software)) wanted.push_back(device);
  }
  return wanted;
}

class EglContext final : public Context {
 public:
  /// Null context when the device does not offer what is needed.
  EglContext(std::shared_ptr<const Egl> egl, EGLDeviceEXT device)
      : egl_(std::move(egl)),
        display_(egl_->get_platform_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr)) {
    if (display_ == EGL_NO_DISPLAY) return;
    if (egl_->initialize(display_, nullptr, nullptr) != EGL_TRUE) {
      display_ = EGL_NO_DISPLAY;
      return;
    }
    if (egl_->bind_api(EGL_OPENGL_API) == EGL_TRUE) context_ = create();
  }

  ~EglContext() override {
    if (display_ == EGL_NO_DISPLAY) return;
    egl_->make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) egl_->destroy_context(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;
  EglContext(EglContext&&) = delete;
  EglContext& operator=(EglContext&&) = delete;

  /// Whether it can be used.
  [[nodiscard]] bool try_current() const {
    return context_ != EGL_NO_CONTEXT &&
           egl_->make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
  }

  void make_current() override {
    if (!try_current()) throw egl_->library.failure("cannot make its context current");
  }

  [[nodiscard]] Function resolve(const char* name) const override {
    return egl_->get_proc_address(name);
  }

 private:
  [[nodiscard]] EGLContext create() const {
    // No surface at all: everything is drawn into framebuffer objects.
    constexpr std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                           EGL_NONE};
    constexpr std::array<EGLint, 7> version{EGL_CONTEXT_MAJOR_VERSION,
                                            4,
                                            EGL_CONTEXT_MINOR_VERSION,
                                            5,
                                            EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                            EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (egl_->choose_config(display_, wanted.data(), &config, 1, &count) != EGL_TRUE || count < 1) {
      return EGL_NO_CONTEXT;
    }
    return egl_->create_context(display_, config, EGL_NO_CONTEXT, version.data());
  }

  std::shared_ptr<const Egl> egl_;
  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<Context> make_egl_context(EglDevice kind) {
  const auto egl = std::make_shared<const Egl>();
  for (const EGLDeviceEXT device : devices_of(*egl, kind)) {
    auto context = std::make_unique<EglContext>(egl, device);
    if (context->try_current()) return context;
  }
  throw egl->library.failure(kind == EglDevice::gpu ? "finds no GPU with OpenGL 4.5"
                                                    : "finds no software device with OpenGL 4.5");
}

}  // namespace sheen::render
