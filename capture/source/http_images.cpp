// SPDX-License-Identifier: MIT
#include "capture/source/http_images.h"

#include "capture/source/ffmpeg_owners.h"
#include "capture/source/jpeg_decoder.h"
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

}  // namespace

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

bool HttpImages::next(NetworkImage& image) {
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
  image.bytes.assign(packet.data, packet.data + packet.size);
  const auto size = jpeg_size(image.bytes);
  const bool is_whole = (packet.flags & AV_PKT_FLAG_CORRUPT) == 0 && size.has_value();
  image.size = size.value_or(ImageSize{});
  av_packet_unref(&packet);
  return is_whole;
}

}  // namespace sheen::capture
