// SPDX-License-Identifier: MIT
#include "capture/source/http_images.h"

#include "capture/source/ffmpeg_owners.h"
#include "capture/source/jpeg_decoder.h"
#include "core/text/lower_case.h"
#include "core/text/number.h"

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>

namespace sheen::capture {
namespace {

constexpr int kMostImageBytes = 64 << 20;
constexpr const char* kCheckAddress = "check the address that the app or the camera shows";

int asks_to_give_up(void* gives_up) {
  return (*static_cast<const std::function<bool()>*>(gives_up))() ? 1 : 0;
}

std::string error_text(int status) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  return av_strerror(status, text.data(), text.size()) == 0 ? text.data() : "unknown fault";
}

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
              "write them into the address: http://USER:PASSWORD@...", true};
    case AVERROR_HTTP_NOT_FOUND:
      return {"has nothing under this path", kCheckAddress, true};
    case AVERROR_PROTOCOL_NOT_FOUND:
      return {"leads to a protocol that is not read", "give an address of http:// or https://",
              true};
    default:
      return {"cannot be opened: " + error_text(status), kCheckAddress, false};
  }
}

}  // namespace

bool is_network_address(const std::string& address) {
  const std::string scheme = core::lower_case(address.substr(0, address.find("://")));
  return address.size() > scheme.size() &&
         (scheme == "http" || scheme == "https" || scheme == "rtsp");
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
  const std::size_t query = std::min(address.find_first_of("?#", host), address.size());
  return core::quotable(address.substr(0, begin) + address.substr(host, query - host), 200);
}

struct HttpImages::Impl {
  std::function<bool()> gives_up;
  BytesPtr bytes;
  InputPtr input;
  PacketPtr packet{av_packet_alloc()};

  void connect(const std::string& address);
  void check_kind() const;
  void read_first_boundary();
};

void HttpImages::Impl::connect(const std::string& address) {
  av_log_set_level(AV_LOG_QUIET);  // faults are told by us, in one line, without the password
  const AVIOInterruptCB interrupt{&asks_to_give_up, &gives_up};
  AVDictionary* options = nullptr;
  av_dict_set(&options, "protocol_whitelist", "http,https,tcp,tls,httpproxy", 0);
  av_dict_set(&options, "tcp_nodelay", "1", 0);
  AVIOContext* opened = nullptr;
  const int status = avio_open2(&opened, address.c_str(), AVIO_FLAG_READ, &interrupt, &options);
  av_dict_free(&options);
  if (status < 0) throw connection_fault(status);
  bytes.reset(opened);
}

/// Refuses web pages and single pictures by what the server calls them.
void HttpImages::Impl::check_kind() const {
  std::uint8_t* text = nullptr;
  if (av_opt_get(bytes.get(), "mime_type", AV_OPT_SEARCH_CHILDREN, &text) < 0 || text == nullptr) {
    return;
  }
  const std::string kind = reinterpret_cast<const char*>(text);
  av_free(text);
  if (kind.empty() || kind.starts_with("multipart/")) return;
  throw NetworkFault("sends " + core::quotable(kind) + ", not a sequence of JPEG images",
                     "give the address of its MJPEG video, often .../video or .../stream", true);
}

void HttpImages::Impl::read_first_boundary() {
  const AVInputFormat* const format = av_find_input_format("mpjpeg");
  AVFormatContext* context = avformat_alloc_context();
  if (context == nullptr || format == nullptr) {
    avformat_free_context(context);
    throw NetworkFault("cannot be read by this build of FFmpeg", "install libavformat", true);
  }
  context->pb = bytes.get();
  context->interrupt_callback = {&asks_to_give_up, &gives_up};
  const int status = avformat_open_input(&context, "", format, nullptr);  // frees it on a fault
  if (status == AVERROR_EXIT) throw connection_fault(status);
  if (status < 0) {
    throw NetworkFault("sends something else than JPEG images", kCheckAddress, false);
  }
  input.reset(context);
}

HttpImages::HttpImages(const std::string& address, std::function<bool()> gives_up)
    : impl_(std::make_unique<Impl>()) {
  impl_->gives_up = std::move(gives_up);
  impl_->connect(address);
  impl_->check_kind();
}

HttpImages::~HttpImages() = default;

bool HttpImages::next(std::vector<std::uint8_t>& jpeg) {
  // Not before: it waits for the first image, and that wait tells a fresh one from a stale one.
  if (!impl_->input) impl_->read_first_boundary();
  AVPacket& packet = *impl_->packet;
  const int status = av_read_frame(impl_->input.get(), &packet);
  if (status == AVERROR_EXIT) {
    throw NetworkFault("sends no more images", "check that it is switched on and in reach", false);
  }
  if (status == AVERROR_EOF) {
    throw NetworkFault("has ended the connection", "check that its app is still open", false);
  }
  if (status < 0) {
    throw NetworkFault("sends something else than JPEG images", kCheckAddress, false);
  }
  if (packet.size > kMostImageBytes) {
    av_packet_unref(&packet);
    throw NetworkFault("sends images of impossible size", kCheckAddress, true);
  }
  jpeg.assign(packet.data, packet.data + packet.size);
  const bool is_whole = (packet.flags & AV_PKT_FLAG_CORRUPT) == 0 && jpeg_size(jpeg).has_value();
  av_packet_unref(&packet);
  return is_whole;
}

}  // namespace sheen::capture
