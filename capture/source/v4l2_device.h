// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/v4l2_system.h"
#include "core/diagnostics/error.h"

#include <filesystem>
#include <string>

namespace sheen::capture {

/// A camera that failed, with the fault alone for messages that say more.
class V4l2Error : public core::Error {
 public:
  V4l2Error(Kind kind, const std::filesystem::path& device, const std::string& fault,
            const std::string& remedy);

  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  std::string fault_;
};

/// An open V4L2 node that captures images into mapped memory. Move-only owner of the descriptor.
class V4l2Device {
 public:
  /// Throws V4l2Error: bad_input when there is no such node or it is no camera, run_failed when it
  /// cannot be opened.
  V4l2Device(V4l2System& system, std::filesystem::path node);
  ~V4l2Device();
  V4l2Device(V4l2Device&& other) noexcept;
  V4l2Device& operator=(V4l2Device&& other) = delete;
  V4l2Device(const V4l2Device&) = delete;
  V4l2Device& operator=(const V4l2Device&) = delete;

  /// One ioctl. Returns 0 or the errno.
  [[nodiscard]] int request(unsigned long code, void* argument) const;
  /// One ioctl that must work; throws V4l2Error that says what was tried.
  void require(unsigned long code, void* argument, const std::string& what) const;

  [[nodiscard]] V4l2System& system() const { return *system_; }
  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] const std::filesystem::path& node() const { return node_; }
  [[nodiscard]] const std::string& name() const { return name_; }  ///< as the driver calls it
  [[nodiscard]] const std::string& bus() const { return bus_; }    ///< where it is plugged in

 private:
  void identify();

  V4l2System* system_;
  std::filesystem::path node_;
  int descriptor_ = -1;
  std::string name_;
  std::string bus_;
};

/// The error for a failed call: `what` was tried and `code` is its errno.
[[nodiscard]] V4l2Error device_fault(const std::filesystem::path& node, const std::string& what,
                                     int code);

}  // namespace sheen::capture
