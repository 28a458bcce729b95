// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/window.h"
#include "app/start/camera_looks.h"
#include "app/start/running_command.h"
#include "app/start/start_commands.h"
#include "render/preview/image_texture.h"

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sheen::app {

/// The newcomer's window: print the sheet, choose a camera and capture, look at what was made. It
/// names the command of every step and runs that command; meanwhile it waits. Lives on the main
/// thread.
class StartWindow {
 public:
  /// Throws core::Error (run_failed) without a display.
  StartWindow(CameraAccess cameras, std::filesystem::path snapshot_folder);

  /// Waits for something to happen, at most this long, and draws once. False when the window is to
  /// be closed.
  bool redraw(double longest_wait_s);

  [[nodiscard]] const StartChoice& choice() const { return choice_; }
  [[nodiscard]] bool is_busy() const { return command_ != nullptr; }
  /// What became of the last command, one line.
  [[nodiscard]] const std::string& outcome() const { return outcome_; }

 private:
  struct ShownPicture {
    const void* pixels = nullptr;  ///< of the image that was sent
    float aspect = 1;              ///< width over height
    std::unique_ptr<render::ImageTexture> texture;
  };
  using Text = std::array<char, 512>;

  void obey(const KeyPress& press);
  void follow_command();
  void run(const Arguments& arguments);
  void open(const std::filesystem::path& path);
  void lay_out();
  void show_sheet_step();
  void show_capture_step();
  void show_open_step();
  void show_foot();
  void show_cameras(float height);
  void show_camera(const CameraLook& look, const ImVec2& size);
  static void show_command(const Arguments& arguments, float y);
  bool step_button(const char* label, bool is_possible);
  const ShownPicture& sent(const std::string& key, const cv::Mat& image);

  CameraAccess cameras_;
  std::filesystem::path snapshot_folder_;
  Window window_;
  std::map<std::string, ShownPicture> pictures_;  ///< by the camera's address or the paper
  std::map<std::string, cv::Mat> sheets_;         ///< as drawn, by the paper
  std::unique_ptr<CameraLooks> looks_;            ///< null while a command runs
  std::vector<CameraLook> seen_;                  ///< by them, last
  StartChoice choice_;
  std::vector<std::filesystem::path> recent_;
  Text address_{};
  Text name_{};
  Text path_{};
  std::unique_ptr<RunningCommand> command_;
  std::string progress_;  ///< of the command
  std::string outcome_;
  bool has_failed_ = false;
  std::filesystem::path made_;  ///< a model that the last command made
  bool snapshot_wanted_ = false;
};

}  // namespace sheen::app
