// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/v4l2_device.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sheen::capture {

/// A setting of a camera: a number, a switch (0 or 1) or a choice out of a menu (its index).
struct CameraControl {
  std::uint32_t id = 0;
  std::string name;  ///< lower case with underscores, as v4l2-ctl writes it: "focus_absolute"
  int minimum = 0;
  int maximum = 0;
  int step = 1;
  int initial = 0;  ///< the driver's default
  int value = 0;    ///< when asked
};

/// A control by name and the value it is to have or has.
struct ControlValue {
  std::string name;
  int value = 0;

  friend bool operator==(const ControlValue&, const ControlValue&) = default;
};

/// Every control that can be written and has one number.
[[nodiscard]] std::vector<CameraControl> camera_controls(const V4l2Device& device);

/// Sets controls in the given order. Throws V4l2Error (bad_input) for a name the camera does not
/// have or a value out of its range, (run_failed) when the driver refuses.
void set_controls(const V4l2Device& device, const std::vector<ControlValue>& values);

/// Keeps the rate constant: no longer exposure in the dark than the rate allows, where the camera
/// has a say in that. For the time before the automatics settle.
void hold_frame_rate(const V4l2Device& device);

/// Ends every automatic of exposure, gain, white balance and focus at the value it had reached, so
/// that a surface keeps its colour from view to view. Returns what was set, automatics included,
/// in an order that `restore_controls` can repeat; controls that the camera lacks or refuses to
/// set are left out.
[[nodiscard]] std::vector<ControlValue> lock_automatics(const V4l2Device& device);

/// Sets values again as far as the camera takes them: one that comes back after being unplugged
/// has forgotten them.
void restore_controls(const V4l2Device& device, const std::vector<ControlValue>& values);

}  // namespace sheen::capture
