// SPDX-License-Identifier: MIT
#include "capture/source/network_images.h"

extern "C" {
#include <libavutil/error.h>
}

#include <array>

namespace sheen::capture {
namespace {

std::string error_text(int status) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  return av_strerror(status, text.data(), text.size()) == 0 ? text.data() : "unknown fault";
}

}  // namespace

NetworkFault connection_fault(int status) {
  switch (status) {
    case AVERROR_EXIT:
    case AVERROR(ETIMEDOUT):
      return {"gives no answer", "check that it is switched on and in this network", false};
    case AVERROR(ECONNREFUSED):
      return {"refuses the connection", "start the app or server on it; check the port", false};
    case AVERROR(EHOSTUNREACH):
    case AVERROR(ENETUNREACH):
      return {"cannot be reached", "check that both are in one network", false};
    case AVERROR_HTTP_UNAUTHORIZED:
    case AVERROR_HTTP_FORBIDDEN:
      return {"wants a user and a password, or others",
              "write them into the address: USER:PASSWORD@ before the host", true};
    case AVERROR_HTTP_NOT_FOUND:
      return {"has nothing under this path", "check the address that the app or the camera shows",
              true};
    case AVERROR_PROTOCOL_NOT_FOUND:
      return {"leads to a protocol that is not read",
              "give an address of http://, https:// or rtsp://", true};
    default:
      return {"cannot be opened: " + error_text(status),
              "check the address that the app or the camera shows", false};
  }
}

}  // namespace sheen::capture
