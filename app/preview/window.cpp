// SPDX-License-Identifier: MIT
#include "app/preview/window.h"

#include "core/diagnostics/error.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <opencv2/core.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace sheen::app {
namespace {

core::Error failure(const std::string& fault) {
  return {core::Error::Kind::run_failed, "window", fault,
          "run it where there is a display (DISPLAY) with OpenGL 4.5, or work without a window"};
}

/// GLFW as long as it is needed; its messages end up in errors, not on stderr.
struct Library {
  Library() {
    if (glfwInit() != GLFW_TRUE) throw failure("cannot reach a display");
  }
  ~Library() { glfwTerminate(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  Library(Library&&) = delete;
  Library& operator=(Library&&) = delete;
};

struct WindowCloser {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using Handle = std::unique_ptr<GLFWwindow, WindowCloser>;

Handle open(const std::string& title, int width, int height) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "sheen");
  Handle handle(glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr));
  if (!handle) throw failure("cannot be opened with OpenGL 4.5 core");
  glfwSetWindowSizeLimits(handle.get(), 640, 400, GLFW_DONT_CARE, GLFW_DONT_CARE);
  return handle;
}

/// ImGui's context with its two backends; after the window's context is current.
struct Interface {
  explicit Interface(GLFWwindow* window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // the program leaves no files behind
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 450 core");
  }
  ~Interface() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;
  Interface(Interface&&) = delete;
  Interface& operator=(Interface&&) = delete;
};

/// What has come between two redraws.
struct Incoming {
  std::vector<KeyPress> presses;
  std::vector<std::filesystem::path> dropped;
};

Incoming& incoming_of(GLFWwindow* window) {
  return *static_cast<Incoming*>(glfwGetWindowUserPointer(window));
}

void note_press(GLFWwindow* window, int key, int /*scancode*/, int action, int modifiers) {
  if (action != GLFW_PRESS) return;
  incoming_of(window).presses.push_back({key, modifiers});
}

void note_drop(GLFWwindow* window, int count, const char** paths) {
  for (const char* path : std::span(paths, static_cast<std::size_t>(count))) {
    incoming_of(window).dropped.emplace_back(path);
  }
}

}  // namespace

struct Window::Impl {
  Impl(const std::string& title, int width, int height) : handle(open(title, width, height)) {
    // Ours first: ImGui calls on whatever was there before it.
    glfwSetWindowUserPointer(handle.get(), &incoming);
    glfwSetKeyCallback(handle.get(), note_press);
    glfwSetDropCallback(handle.get(), note_drop);
    glfwMakeContextCurrent(handle.get());
    glfwSwapInterval(1);
    interface = std::make_unique<Interface>(handle.get());
  }

  Library library;
  Handle handle;
  std::unique_ptr<Interface> interface;
  Incoming incoming;
};

Window::Window(const std::string& title, int width, int height)
    : impl_(std::make_unique<Impl>(title, width, height)), gl_(render::gl::load_functions(*this)) {}

void Window::check_display() {
  const Library library;
}

Window::~Window() {
  make_current();
}

void Window::make_current() {
  glfwMakeContextCurrent(impl_->handle.get());
}

Window::Function Window::resolve(const char* name) const {
  return glfwGetProcAddress(name);
}

void Window::begin_redraw(double longest_wait_s) {
  if (longest_wait_s > 0) {
    glfwWaitEventsTimeout(longest_wait_s);
  } else {
    glfwPollEvents();
  }
  presses_ = std::exchange(impl_->incoming.presses, {});
  dropped_ = std::exchange(impl_->incoming.dropped, {});
  follow_content_scale();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Window::follow_content_scale() {
  float scale = 1;
  glfwGetWindowContentScale(impl_->handle.get(), &scale, nullptr);
  scale = std::clamp(scale, 0.5f, 4.0f);
  if (scale == content_scale_) return;
  fonts_ = theme::apply(scale);
  if (content_scale_ != 0) {
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }
  content_scale_ = scale;
}

void Window::draw() {
  ImGui::Render();
  const ImGuiIO& io = ImGui::GetIO();
  const auto width_px = static_cast<int>(io.DisplaySize.x * io.DisplayFramebufferScale.x);
  const auto height_px = static_cast<int>(io.DisplaySize.y * io.DisplayFramebufferScale.y);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl_.Viewport(0, 0, width_px, height_px);
  const std::array<float, 4> background{theme::kBackground.x, theme::kBackground.y,
                                        theme::kBackground.z, 1};
  gl_.ClearNamedFramebufferfv(0, GL_COLOR, 0, background.data());
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::show() {
  glfwSwapBuffers(impl_->handle.get());
}

bool Window::wants_to_close() const {
  return glfwWindowShouldClose(impl_->handle.get()) != 0;
}

void Window::close() {
  glfwSetWindowShouldClose(impl_->handle.get(), GLFW_TRUE);
}

void Window::wake() {
  glfwPostEmptyEvent();
}

cv::Mat Window::image() const {
  int width_px = 0;
  int height_px = 0;
  glfwGetFramebufferSize(impl_->handle.get(), &width_px, &height_px);
  cv::Mat image(height_px, width_px, CV_8UC3);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, width_px, height_px, GL_BGR, GL_UNSIGNED_BYTE, image.data);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 4);
  cv::flip(image, image, 0);
  return image;
}

}  // namespace sheen::app
