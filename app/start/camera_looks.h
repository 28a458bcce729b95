// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/camera.h"
#include "capture/source/v4l2_camera.h"
#include "capture/source/v4l2_listing.h"

#include <opencv2/core/mat.hpp>

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace sheen::app {

/// A camera that may be chosen and what it sees.
struct CameraLook {
  std::string address = {};  ///< /dev/video0, http://...
  std::string name = {};
  std::string mode = {};   ///< "1280x720, 30 a second"; empty: not known
  cv::Mat picture = {};    ///< CV_8UC3 BGR, shared, never written to; empty: none (yet)
  std::string fault = {};  ///< one line; empty: none
  bool is_due = true;      ///< has not been looked through yet
};

/// Who lists cameras and opens them.
struct CameraAccess {
  std::function<std::vector<capture::CameraListing>()> list;
  std::function<std::unique_ptr<capture::Camera>(const std::string& address)> open;
};

/// The kernel's cameras, and those in the network. They are opened for a moment only: automatics
/// stay as they are.
CameraAccess cameras_of_this_machine();

/// Opens a camera, takes a picture and lets go of it again. Pictures of a compressed video are not
/// decoded for it: the camera is named, without a picture. Throws nothing that a camera may do
/// wrong: that is the look's fault.
CameraLook look_through(const CameraAccess& cameras, const std::string& address,
                        const std::string& name);

/// Looks through the machine's cameras one after another, on a thread of its own, and through those
/// in the network that it is told of. While it exists cameras may be in use: it goes before a
/// capture begins, after the camera at hand.
class CameraLooks {
 public:
  /// `on_news` (may be empty) is called on that thread whenever `looks` has changed.
  explicit CameraLooks(CameraAccess cameras, std::function<void()> on_news = {});

  /// In the order in which they were found. Never waits for a camera.
  [[nodiscard]] std::vector<CameraLook> looks() const;
  /// Whether cameras are still being listed.
  [[nodiscard]] bool is_listing() const;
  /// One that no list names.
  void add(const std::string& address);

 private:
  void run(const std::stop_token& stop);
  void list();
  [[nodiscard]] CameraLook* find(const std::string& address);

  CameraAccess cameras_;
  std::function<void()> on_news_;
  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable_any has_work_;
  std::deque<CameraLook> looks_;
  bool is_listing_ = true;
  std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace sheen::app
