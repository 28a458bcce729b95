// SPDX-License-Identifier: MIT
#include "capture/session/matroska_muxer.h"

#include "capture/source/ffmpeg_owners.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace sheen::capture {
namespace {

constexpr int kBufferBytes = 1 << 16;
constexpr int kMostReordered = 16;  // pictures, as FFmpeg allows
constexpr AVRational kMilliseconds{1, 1000};

struct FreeOutput {
  void operator()(AVFormatContext* output) const { avformat_free_context(output); }
};

void require(bool is_good) {
  if (!is_good) throw std::runtime_error("FFmpeg cannot write Matroska");
}

/// What FFmpeg writes, in memory.
struct Pieces {
  std::vector<FilePiece> pieces;
  std::uint64_t place = 0, end = 0;

  static int write(void* opaque, std::uint8_t* bytes, int count) {
    auto& self = *static_cast<Pieces*>(opaque);
    self.pieces.push_back({self.place, {bytes, bytes + count}});
    self.place += static_cast<std::uint64_t>(count);
    self.end = std::max(self.end, self.place);
    return count;
  }

  static std::int64_t seek(void* opaque, std::int64_t offset, int whence) {
    auto& self = *static_cast<Pieces*>(opaque);
    if (whence == AVSEEK_SIZE) return static_cast<std::int64_t>(self.end);
    if (whence != SEEK_SET || offset < 0) return -1;
    self.place = static_cast<std::uint64_t>(offset);
    return offset;
  }
};

}  // namespace

struct MatroskaMuxer::Impl {
  Pieces sink;
  BytesOfOursPtr bytes;
  std::unique_ptr<AVFormatContext, FreeOutput> output;
  PacketPtr packet{av_packet_alloc()};
  std::int64_t last_ms = std::numeric_limits<std::int64_t>::min();

  std::vector<FilePiece> take() {
    avio_flush(bytes.get());
    return std::exchange(sink.pieces, {});
  }
};

MatroskaMuxer::MatroskaMuxer(const VideoHeader& video, const ImageSize& size)
    : impl_(std::make_unique<Impl>()) {
  AVFormatContext* made = nullptr;
  require(avformat_alloc_output_context2(&made, nullptr, "matroska", nullptr) >= 0);
  impl_->output.reset(made);
  impl_->bytes.reset(avio_alloc_context(static_cast<std::uint8_t*>(av_malloc(kBufferBytes)),
                                        kBufferBytes, 1, &impl_->sink, nullptr, &Pieces::write,
                                        &Pieces::seek));
  AVStream* const stream = avformat_new_stream(made, nullptr);
  const AVCodecDescriptor* const codec = avcodec_descriptor_get_by_name(video.codec.c_str());
  require(impl_->bytes && impl_->packet && stream != nullptr && codec != nullptr);
  made->pb = impl_->bytes.get();
  made->flags |= AVFMT_FLAG_BITEXACT;
  stream->time_base = kMilliseconds;
  AVCodecParameters& parameters = *stream->codecpar;
  parameters.codec_type = AVMEDIA_TYPE_VIDEO;
  parameters.codec_id = codec->id;
  parameters.width = size.width_px;
  parameters.height = size.height_px;
  parameters.video_delay = kMostReordered;
  parameters.extradata =
      static_cast<std::uint8_t*>(av_mallocz(video.setup.size() + AV_INPUT_BUFFER_PADDING_SIZE));
  require(parameters.extradata != nullptr);
  parameters.extradata_size = static_cast<int>(video.setup.size());
  std::copy(video.setup.begin(), video.setup.end(), parameters.extradata);
  require(avformat_write_header(made, nullptr) >= 0);
}

MatroskaMuxer::~MatroskaMuxer() = default;
MatroskaMuxer::MatroskaMuxer(MatroskaMuxer&&) noexcept = default;
MatroskaMuxer& MatroskaMuxer::operator=(MatroskaMuxer&&) noexcept = default;

std::vector<FilePiece> MatroskaMuxer::begin() {
  return impl_->take();
}

std::vector<FilePiece> MatroskaMuxer::add(const LiveImage& picture) {
  AVPacket& packet = *impl_->packet;
  require(av_new_packet(&packet, static_cast<int>(picture.bytes->size())) >= 0);
  std::copy(picture.bytes->begin(), picture.bytes->end(), packet.data);
  const std::int64_t rounded = picture.time_us >= 0 ? 500 : -500;
  packet.pts = (picture.time_us + rounded) / 1000;
  if (packet.pts == impl_->last_ms) ++packet.pts;  // two pictures never have one time
  impl_->last_ms = packet.pts;
  packet.flags = picture.is_key ? AV_PKT_FLAG_KEY : 0;
  const int status = av_write_frame(impl_->output.get(), &packet);
  av_packet_unref(&packet);
  // Without a packet: the cluster ends here.
  require(status >= 0 && av_write_frame(impl_->output.get(), nullptr) >= 0);
  return impl_->take();
}

std::vector<FilePiece> MatroskaMuxer::finish() {
  require(av_write_trailer(impl_->output.get()) >= 0);
  return impl_->take();
}

std::vector<std::uint8_t> joined(const std::vector<FilePiece>& pieces) {
  std::vector<std::uint8_t> bytes;
  for (const FilePiece& piece : pieces) {
    bytes.insert(bytes.end(), piece.bytes.begin(), piece.bytes.end());
  }
  return bytes;
}

}  // namespace sheen::capture
