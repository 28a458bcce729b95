// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "render/context/context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sheen::render {
namespace {

constexpr const char* kLibrary = "libEGL.so.1";

core::Error failure(const std::string& fault) {
  return {core::Error::Kind::run_failed, kLibrary, fault,
          "install the package libegl1 and a driver with OpenGL 4.5"};
}

/// Opened at run time, so that machines without it still run everything else; never unloaded, since
/// drivers leave hooks for the end of the process.
void* open_library() {
  void* const library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr) throw failure("cannot be loaded");
  return library;
}

template <typename Pointer>
Pointer symbol(void* library, const char* name) {
  void* const address = dlsym(library, name);
  if (address == nullptr) throw failure(std::string("lacks ") + name);
  return reinterpret_cast<Pointer>(address);
}

/// The entry points this file calls.
struct Egl {
  void* library = open_library();
  decltype(&eglGetProcAddress) get_proc_address =
      core_function<decltype(&eglGetProcAddress)>("eglGetProcAddress");
  decltype(&eglInitialize) initialize = core_function<decltype(&eglInitialize)>("eglInitialize");
  decltype(&eglTerminate) terminate = core_function<decltype(&eglTerminate)>("eglTerminate");
  decltype(&eglBindAPI) bind_api = core_function<decltype(&eglBindAPI)>("eglBindAPI");
  decltype(&eglChooseConfig) choose_config =
      core_function<decltype(&eglChooseConfig)>("eglChooseConfig");
  decltype(&eglCreateContext) create_context =
      core_function<decltype(&eglCreateContext)>("eglCreateContext");
  decltype(&eglDestroyContext) destroy_context =
      core_function<decltype(&eglDestroyContext)>("eglDestroyContext");
  decltype(&eglMakeCurrent) make_current =
      core_function<decltype(&eglMakeCurrent)>("eglMakeCurrent");
  PFNEGLQUERYDEVICESEXTPROC query_devices =
      extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string =
      extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display =
      extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");

 private:
  template <typename Pointer>
  [[nodiscard]] Pointer core_function(const char* name) const {
    return symbol<Pointer>(library, name);
  }
  template <typename Pointer>
  [[nodiscard]] Pointer extension(const char* name) const {
    const auto pointer = reinterpret_cast<Pointer>(get_proc_address(name));
    if (pointer == nullptr) throw failure(std::string("lacks ") + name);
    return pointer;
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
    if (!try_current()) throw failure("cannot make its context current");
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
  throw failure(kind == EglDevice::gpu ? "finds no GPU with OpenGL 4.5"
                                       : "finds no software device with OpenGL 4.5");
}

}  // namespace sheen::render
