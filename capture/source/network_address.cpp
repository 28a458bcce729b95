// SPDX-License-Identifier: MIT
#include "capture/source/network_address.h"

#include "core/text/lower_case.h"
#include "core/text/number.h"

#include <algorithm>

namespace sheen::capture {
namespace {

std::string scheme_of(const std::string& address) {
  const std::size_t end = address.find("://");
  return end == std::string::npos ? "" : core::lower_case(address.substr(0, end));
}

}  // namespace

bool is_rtsp_address(const std::string& address) {
  const std::string scheme = scheme_of(address);
  return scheme == "rtsp" || scheme == "rtsps";
}

bool is_network_address(const std::string& address) {
  const std::string scheme = scheme_of(address);
  return scheme == "http" || scheme == "https" || is_rtsp_address(address);
}

std::string shown_address(const std::string& address) {
  const std::size_t scheme = address.find("://");
  if (scheme == std::string::npos) return address;
  const std::size_t begin = scheme + 3;
  const std::size_t end = std::min(address.find_first_of("/?#", begin), address.size());
  const std::size_t at = address.rfind('@');
  // An @ behind the host may belong to a password with a letter that ends the host.
  if (at != std::string::npos && at > end) return address.substr(0, begin) + "...";
  const std::size_t host = at == std::string::npos ? begin : at + 1;
  std::size_t query = std::min(address.find_first_of("?#", host), address.size());
  // Some cameras want user and password in the path.
  const std::string path = core::lower_case(address.substr(end, query - end));
  if (path.find("pass") != std::string::npos || path.find("pwd") != std::string::npos) query = end;
  return core::quotable(address.substr(0, begin) + address.substr(host, query - host), 200);
}

}  // namespace sheen::capture
