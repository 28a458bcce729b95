// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/theme.h"
#include "render/context/context.h"
#include "render/gl/functions.h"

#include <opencv2/core/mat.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace sheen::app {

/// A key that went down, by GLFW's names (GLFW_KEY_F, GLFW_MOD_CONTROL).
struct KeyPress {
  int key = 0;
  int modifiers = 0;
};

/// One window with an OpenGL 4.5 core context and ImGui in it. Lives on the main thread; one at a
/// time.
class Window final : public render::Context {
 public:
  /// Sizes in units of the content scale. Throws core::Error (run_failed) without a display or
  /// without OpenGL 4.5.
  Window(const std::string& title, int width, int height);
  ~Window() override;
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  Window(Window&&) = delete;
  Window& operator=(Window&&) = delete;

  /// Throws as the constructor does where there is no display, and leaves no trace.
  static void check_display();

  void make_current() override;
  [[nodiscard]] Function resolve(const char* name) const override;

  /// Takes in events, waiting for the first at most this long, and begins a redraw.
  void begin_redraw(double longest_wait_s);
  /// Draws ImGui's lists; `image` can be read now.
  void draw();
  /// Shows what was drawn.
  void show();

  /// Keys that went down since the last redraw, in order; none is lost however slow redraws are.
  [[nodiscard]] const std::vector<KeyPress>& key_presses() const { return presses_; }

  /// Files and folders that were dropped on the window since the last redraw.
  [[nodiscard]] const std::vector<std::filesystem::path>& dropped() const { return dropped_; }

  [[nodiscard]] bool wants_to_close() const;
  void close();
  /// Wakes `begin_redraw`; may be called from any thread.
  static void wake();

  /// What `draw` has drawn and `show` has not yet shown, CV_8UC3 BGR.
  [[nodiscard]] cv::Mat image() const;

  [[nodiscard]] const theme::Fonts& fonts() const { return fonts_; }
  [[nodiscard]] float content_scale() const { return content_scale_; }
  [[nodiscard]] const render::gl::Functions& gl() const { return gl_; }

 private:
  struct Impl;
  void follow_content_scale();

  std::unique_ptr<Impl> impl_;
  render::gl::Functions gl_;
  theme::Fonts fonts_;
  float content_scale_ = 0;
  std::vector<KeyPress> presses_;
  std::vector<std::filesystem::path> dropped_;
};

}  // namespace sheen::app
