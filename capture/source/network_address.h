// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sheen::capture {

/// Whether an address names a camera in the network: http://, https://, rtsp:// or rtsps://.
bool is_network_address(const std::string& address);

/// Whether it names one that sends compressed video: rtsp:// or rtsps://.
bool is_rtsp_address(const std::string& address);

/// The address as it may stand in messages and files: without user, password and query. Names of
/// files and devices stay as they are.
std::string shown_address(const std::string& address);

}  // namespace sheen::capture
