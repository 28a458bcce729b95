// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_controls.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cctype>
#include <optional>

namespace sheen::capture {
namespace {

/// A driver that repeats itself must not hold the program.
constexpr std::size_t most_controls = 1024;

/// An automatic, its position "off", and the values it moves.
struct Automatic {
  __u32 id;
  int off;
  std::vector<__u32> moved;
};

const std::vector<Automatic>& automatics() {
  static const std::vector<Automatic> all{
      {V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, {V4L2_CID_EXPOSURE_ABSOLUTE}},
      {V4L2_CID_AUTOGAIN, 0, {V4L2_CID_GAIN}},
      {V4L2_CID_AUTO_WHITE_BALANCE,
       0,
       {V4L2_CID_WHITE_BALANCE_TEMPERATURE, V4L2_CID_RED_BALANCE, V4L2_CID_BLUE_BALANCE}},
      {V4L2_CID_FOCUS_AUTO, 0, {V4L2_CID_FOCUS_ABSOLUTE}}};
  return all;
}

/// "White Balance, Automatic" -> "white_balance_automatic", the spelling of v4l2-ctl.
std::string plain_name(const __u8 (&driver_name)[32]) {
  std::string name;
  for (const __u8 letter : driver_name) {
    if (letter == 0) break;
    if (std::isalnum(letter))
      name += static_cast<char>(std::tolower(letter));
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

bool has_one_number(__u32 type) {
  return type == V4L2_CTRL_TYPE_INTEGER || type == V4L2_CTRL_TYPE_BOOLEAN ||
         type == V4L2_CTRL_TYPE_MENU || type == V4L2_CTRL_TYPE_INTEGER_MENU ||
         type == V4L2_CTRL_TYPE_BITMASK || type == V4L2_CTRL_TYPE_BUTTON;
}

std::optional<int> read_value(const V4l2Device& device, __u32 id) {
  v4l2_control control{id, 0};
  if (device.request(VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
  return control.value;
}

/// Returns 0 or the errno.
int write_value(const V4l2Device& device, __u32 id, int value) {
  v4l2_control control{id, value};
  return device.request(VIDIOC_S_CTRL, &control);
}

const CameraControl* find(const std::vector<CameraControl>& controls, __u32 id) {
  const auto found = std::find_if(controls.begin(), controls.end(),
                                  [&](const CameraControl& control) { return control.id == id; });
  return found == controls.end() ? nullptr : &*found;
}

const CameraControl& find(const std::vector<CameraControl>& controls, const std::string& name,
                          const V4l2Device& device) {
  const auto found =
      std::find_if(controls.begin(), controls.end(),
                   [&](const CameraControl& control) { return control.name == name; });
  if (found != controls.end()) return *found;
  std::string names;
  for (const CameraControl& control : controls) names += (names.empty() ? "" : ", ") + control.name;
  throw V4l2Error(core::Error::Kind::bad_input, device.node(),
                  "the camera has no control \"" + name + "\"",
                  names.empty() ? "it has no controls at all" : "it has " + names);
}

/// Writes one value and keeps it for later when the driver took it.
void write_and_keep(const V4l2Device& device, const CameraControl& control, int value,
                    std::vector<ControlValue>& kept) {
  const int allowed = std::clamp(value, control.minimum, control.maximum);
  if (write_value(device, control.id, allowed) == 0) kept.push_back({control.name, allowed});
}

}  // namespace

std::vector<CameraControl> camera_controls(const V4l2Device& device) {
  std::vector<CameraControl> controls;
  v4l2_queryctrl entry{};
  entry.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  while (controls.size() < most_controls && device.request(VIDIOC_QUERYCTRL, &entry) == 0) {
    const __u32 id = entry.id;
    const bool closed = (entry.flags & (V4L2_CTRL_FLAG_DISABLED | V4L2_CTRL_FLAG_READ_ONLY)) != 0;
    if (!closed && has_one_number(entry.type) && entry.minimum <= entry.maximum) {
      const int value = read_value(device, id).value_or(entry.default_value);
      controls.push_back({id, plain_name(entry.name), entry.minimum, entry.maximum,
                          std::max(entry.step, 1), entry.default_value, value});
    }
    entry = {};
    entry.id = id | V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  return controls;
}

void set_controls(const V4l2Device& device, const std::vector<ControlValue>& values) {
  if (values.empty()) return;
  const auto controls = camera_controls(device);
  for (const ControlValue& wanted : values) {
    const CameraControl& control = find(controls, wanted.name, device);
    if (wanted.value < control.minimum || wanted.value > control.maximum)
      throw V4l2Error(core::Error::Kind::bad_input, device.node(),
                      wanted.name + " cannot be " + std::to_string(wanted.value),
                      "choose a value from " + std::to_string(control.minimum) + " to " +
                          std::to_string(control.maximum));
    if (const int fault = write_value(device, control.id, wanted.value))
      throw device_fault(device.node(), "setting " + wanted.name, fault);
  }
}

void hold_frame_rate(const V4l2Device& device) {
  // Most cameras have no such control, which is as good.
  static_cast<void>(write_value(device, V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0));
}

std::vector<ControlValue> lock_automatics(const V4l2Device& device) {
  // Read all values first: switching one automatic off may move what another is about to report.
  const auto controls = camera_controls(device);
  std::vector<ControlValue> kept;
  for (const Automatic& automatic : automatics()) {
    if (const CameraControl* control = find(controls, automatic.id))
      write_and_keep(device, *control, automatic.off, kept);
    for (const __u32 id : automatic.moved)
      if (const CameraControl* control = find(controls, id))
        write_and_keep(device, *control, control->value, kept);
  }
  return kept;
}

void restore_controls(const V4l2Device& device, const std::vector<ControlValue>& values) {
  const auto controls = camera_controls(device);
  for (const ControlValue& wanted : values)
    for (const CameraControl& control : controls)
      if (control.name == wanted.name)
        static_cast<void>(write_value(device, control.id, wanted.value));
}

}  // namespace sheen::capture
