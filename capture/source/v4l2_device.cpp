// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_device.h"

#include <linux/videodev2.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace sheen::capture {
namespace {

/// Text of a fixed field that a driver may have filled to the brim.
template <std::size_t N>
std::string field_text(const __u8 (&field)[N]) {
  std::string text(N, '\0');
  std::memcpy(text.data(), field, N);
  return text.substr(0, text.find('\0'));
}

std::string remedy_for(int code) {
  switch (code) {
    case EBUSY:
      return "close the program that uses it";
    case ENODEV:
    case ENXIO:
      return "plug it in again";
    case EACCES:
    case EPERM:
      return "let this user read it, for instance by joining the group \"video\"";
    default:
      return "unplug it and plug it in again, or try another mode";
  }
}

V4l2Error no_camera(const std::filesystem::path& node, const std::string& fault) {
  return {core::Error::Kind::bad_input, node, fault,
          "\"sheen capture --list\" shows the cameras of this machine"};
}

/// What there is instead of a device of that name.
std::string missing_device(const std::filesystem::path& node) {
  const std::string name = node.string();
  if (name.empty()) return "the name of the camera is empty";
  if (name.find_first_not_of("0123456789") == std::string::npos) {
    return "there is no such device; is /dev/video" + name + " meant?";
  }
  return "there is no such device";
}

}  // namespace

V4l2Error::V4l2Error(Kind kind, const std::filesystem::path& device, const std::string& fault,
                     const std::string& remedy)
    : core::Error(kind, device, fault, remedy), fault_(fault) {}

V4l2Error device_fault(const std::filesystem::path& node, const std::string& what, int code) {
  return {core::Error::Kind::run_failed, node,
          what + " failed: " + std::generic_category().message(code), remedy_for(code)};
}

V4l2Device::V4l2Device(V4l2System& system, std::filesystem::path node)
    : system_(&system), node_(std::move(node)), descriptor_(system.open(node_)) {
  if (descriptor_ < 0) {
    if (errno == ENOENT) throw no_camera(node_, missing_device(node_));
    if (errno == EISDIR) throw no_camera(node_, "this is a folder, not a video device");
    throw device_fault(node_, "opening", errno);
  }
  try {
    identify();
  } catch (...) {
    system_->close(descriptor_);
    throw;
  }
}

V4l2Device::~V4l2Device() {
  if (descriptor_ >= 0) system_->close(descriptor_);
}

V4l2Device::V4l2Device(V4l2Device&& other) noexcept
    : system_(other.system_),
      node_(std::move(other.node_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      name_(std::move(other.name_)),
      bus_(std::move(other.bus_)) {}

int V4l2Device::request(unsigned long code, void* argument) const {
  return system_->ioctl(descriptor_, code, argument) == -1 ? errno : 0;
}

void V4l2Device::require(unsigned long code, void* argument, const std::string& what) const {
  if (const int fault = request(code, argument)) throw device_fault(node_, what, fault);
}

void V4l2Device::identify() {
  v4l2_capability capability{};
  const int fault = request(VIDIOC_QUERYCAP, &capability);
  if (fault == ENOTTY || fault == EINVAL) throw no_camera(node_, "this is not a video device");
  if (fault != 0) throw device_fault(node_, "asking what it can do", fault);

  name_ = field_text(capability.card);
  bus_ = field_text(capability.bus_info);

  // A driver with several nodes says with device_caps what this one does.
  const __u32 abilities = (capability.capabilities & V4L2_CAP_DEVICE_CAPS)
                              ? capability.device_caps
                              : capability.capabilities;
  const __u32 needed = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  if ((abilities & needed) != needed) throw no_camera(node_, "it does not stream images");
}

}  // namespace sheen::capture
