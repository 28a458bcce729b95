// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/camera.h"
#include "capture/source/v4l2_controls.h"
#include "capture/source/v4l2_image_order.h"
#include "capture/source/v4l2_modes.h"
#include "capture/source/v4l2_stream.h"

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sheen::capture {

/// How a V4L2 camera is to be used.
struct V4l2CameraOptions {
  std::filesystem::path device = "/dev/video0";
  ModeWish mode = {};
  std::vector<ControlValue> controls = {};  ///< set before the automatics settle
  bool lock_automatics = true;  ///< exposure, gain, white balance and focus, once settled
  double settle_s = 1.5;        ///< >= 0, time for the automatics; their images are dropped
  double silence_s = 5;         ///< > 0, without an image a stream counts as broken
  double reconnect_s = 30;      ///< >= 0, how long a camera that failed may stay away
};

/// A camera of the Linux kernel: mapped streaming of MJPEG, YUYV or NV12. A stream that breaks, or
/// a camera that is unplugged, is opened again with the same mode and control values when it is
/// back, and its images are numbered on.
class V4l2Camera : public Camera {
 public:
  /// Opens the device, lets the automatics settle and locks them: takes `settle_s`. Throws
  /// V4l2Error: bad_input for a device, mode or control that does not exist, run_failed when the
  /// camera does not start. `system` must outlive the camera.
  V4l2Camera(V4l2System& system, V4l2CameraOptions options);

  std::optional<CameraBuffer> next(std::chrono::milliseconds timeout) override;
  [[nodiscard]] CameraDescription description() const override { return description_; }
  [[nodiscard]] CameraCounts counts() const override { return counts_; }

  /// What the automatics were stopped at.
  [[nodiscard]] const std::vector<ControlValue>& locked() const { return locked_; }

 private:
  struct Connection {
    V4l2Device device;
    ActiveMode active;
    V4l2Stream stream;

    Connection(V4l2Device opened, const CameraMode& mode);
  };
  using Time = std::chrono::nanoseconds;

  void start();
  void discard(double duration_s);
  [[nodiscard]] V4l2Device find_again();
  void reconnect(Time deadline);
  void disconnect(const std::string& fault);
  [[nodiscard]] std::optional<CameraBuffer> receive(Time deadline);
  [[nodiscard]] std::optional<CameraBuffer> deliver(const V4l2Image& image);
  void check_patience() const;

  V4l2System& system_;
  V4l2CameraOptions options_;
  std::unique_ptr<Connection> connection_;  ///< null while the camera is away
  CameraMode mode_;
  std::string bus_;
  CameraDescription description_;
  CameraCounts counts_;
  std::vector<ControlValue> locked_;
  ImageOrder order_;
  Time last_heard_{};                  ///< of the last image or the last start
  std::optional<Time> failing_since_;  ///< first fault after the last good image
  Time next_attempt_{};
  std::string last_fault_;
};

}  // namespace sheen::capture
