// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

namespace sheen::tests {

/// A display of its own (Xvfb) and hands to type and point with (xdotool); no screen is needed.
class VirtualDisplay {
 public:
  /// Opens one and points DISPLAY at it; null where Xvfb or xdotool is not installed.
  static std::unique_ptr<VirtualDisplay> open(int width_px, int height_px);
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;
  VirtualDisplay(VirtualDisplay&&) = delete;
  VirtualDisplay& operator=(VirtualDisplay&&) = delete;

  /// Runs xdotool with these arguments and waits for it: events have then been sent.
  void act(const std::vector<std::string>& arguments) const;

 private:
  explicit VirtualDisplay(pid_t server) : server_(server) {}
  pid_t server_;
};

}  // namespace sheen::tests
