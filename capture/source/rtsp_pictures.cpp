// SPDX-License-Identifier: MIT
#include "capture/source/rtsp_pictures.h"

#include "capture/source/ffmpeg_owners.h"
#include "core/text/number.h"

extern "C" {
#include <libavcodec/bsf.h>
}

#include <algorithm>
#include <optional>
#include <utility>

namespace sheen::capture {
namespace {

constexpr int kMostPictureBytes = 64 << 20;
constexpr std::int64_t kMostPicturePixels = std::int64_t{1} << 28;
constexpr int kMostUndecodable = 20;  // pictures that claim to need no others, in a row

int asks_to_end(void* gives_up) {
  return (*static_cast<const std::function<bool()>*>(gives_up))() ? 1 : 0;
}

struct FreeFilter {
  void operator()(AVBSFContext* filter) const { av_bsf_free(&filter); }
};

/// The parameter sets that a picture brings along; empty where it brings none.
std::vector<std::uint8_t> setup_within(const AVPacket& picture, const AVCodecParameters& codec) {
  AVBSFContext* made = nullptr;
  const AVBitStreamFilter* const kind = av_bsf_get_by_name("extract_extradata");
  if (kind == nullptr || av_bsf_alloc(kind, &made) < 0) return {};
  const std::unique_ptr<AVBSFContext, FreeFilter> filter(made);
  const PacketPtr copy(av_packet_clone(&picture));
  if (!copy || avcodec_parameters_copy(filter->par_in, &codec) < 0 ||
      av_bsf_init(filter.get()) < 0 || av_bsf_send_packet(filter.get(), copy.get()) < 0 ||
      av_bsf_receive_packet(filter.get(), copy.get()) < 0) {
    return {};
  }
  std::size_t size = 0;
  const auto* found = av_packet_get_side_data(copy.get(), AV_PKT_DATA_NEW_EXTRADATA, &size);
  return found == nullptr ? std::vector<std::uint8_t>{}
                          : std::vector<std::uint8_t>(found, found + size);
}

struct FreeParser {
  void operator()(AVCodecParserContext* parser) const { av_parser_close(parser); }
};

/// A decoder, not opened.
CodecPtr decoder_of(const VideoHeader& header) {
  const AVCodec* const decoder = avcodec_find_decoder_by_name(header.codec.c_str());
  CodecPtr codec(decoder == nullptr ? nullptr : avcodec_alloc_context3(decoder));
  if (!codec) return nullptr;
  codec->max_pixels = kMostPicturePixels;
  codec->thread_count = 1;
  codec->extradata =
      static_cast<std::uint8_t*>(av_mallocz(header.setup.size() + AV_INPUT_BUFFER_PADDING_SIZE));
  if (codec->extradata == nullptr) return nullptr;
  codec->extradata_size = static_cast<int>(header.setup.size());
  std::copy(header.setup.begin(), header.setup.end(), codec->extradata);
  return codec;
}

/// Size of a picture that needs no others, by decoding it; nothing where it cannot be decoded.
std::optional<ImageSize> decoded_size(const AVPacket& picture, const VideoHeader& header) {
  const CodecPtr codec = decoder_of(header);
  const FramePtr frame(av_frame_alloc());
  if (!codec || !frame || avcodec_open2(codec.get(), nullptr, nullptr) < 0 ||
      avcodec_send_packet(codec.get(), &picture) < 0 ||
      avcodec_send_packet(codec.get(), nullptr) < 0 ||
      avcodec_receive_frame(codec.get(), frame.get()) < 0) {
    return std::nullopt;
  }
  return ImageSize{frame->width, frame->height};
}

NetworkFault wrong_kind(const std::string& codec) {
  return {"sends " + core::quotable(codec) + ", which is not recorded",
          "set it to H.264; of JPEG images give the address by http://", true};
}

}  // namespace

struct RtspPictures::Impl {
  std::function<bool()> gives_up;
  InputPtr input;
  int stream_index = -1;
  VideoHeader header;
  CodecPtr codec;  ///< for the parser, which finds the pictures that need no others
  std::unique_ptr<AVCodecParserContext, FreeParser> parser;
  ImageSize size;

  PacketPtr part{av_packet_alloc()};  ///< of a picture, as it came in one piece
  bool has_part = false;              ///< `part` begins the next picture
  PacketPtr picture{av_packet_alloc()};
  bool has_first = false;             ///< `picture` is the first one, not delivered yet
  int skipped = 0;                    ///< pictures since there is none to begin with
  std::optional<NetworkFault> ended;  ///< thrown when `picture` is delivered

  void connect(const std::string& address);
  void choose_stream();
  void read_part();
  void read_picture();
  [[nodiscard]] bool is_key();
  bool is_start();
  void wait_for_start();
  [[nodiscard]] const AVStream& stream() const { return *input->streams[stream_index]; }
};

void RtspPictures::Impl::connect(const std::string& address) {
  av_log_set_level(AV_LOG_QUIET);  // faults are told by us, in one line, without the password
  AVFormatContext* context = avformat_alloc_context();
  if (context == nullptr) throw std::bad_alloc();
  context->interrupt_callback = {&asks_to_end, &gives_up};
  // FFmpeg's joining of pictures loses the stamp of the first.
  context->flags |= AVFMT_FLAG_NOPARSE | AVFMT_FLAG_NOFILLIN;
  AVDictionary* options = nullptr;
  av_dict_set(&options, "rtsp_transport", "tcp", 0);
  av_dict_set(&options, "allowed_media_types", "video", 0);
  av_dict_set(&options, "protocol_whitelist", "rtsp,rtsps,rtp,tcp,tls", 0);
  const int status = avformat_open_input(&context, address.c_str(), av_find_input_format("rtsp"),
                                         &options);  // frees the context on a fault
  av_dict_free(&options);
  // FFmpeg tells a server that was given up from one that hung up only here and there.
  if (status < 0 && gives_up()) throw connection_fault(AVERROR_EXIT);
  if (status == AVERROR_INVALIDDATA || status == AVERROR_EOF) {
    throw NetworkFault("does not speak RTSP", "check address and port", false);
  }
  if (status < 0) throw connection_fault(status);
  input.reset(context);
}

void RtspPictures::Impl::choose_stream() {
  for (unsigned i = 0; i < input->nb_streams && stream_index < 0; ++i) {
    if (input->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO) {
      stream_index = static_cast<int>(i);
    }
  }
  if (stream_index < 0) {
    throw NetworkFault("sends no video", "check the path of the address", true);
  }
  const AVCodecParameters& stated = *stream().codecpar;
  header.codec = avcodec_get_name(stated.codec_id);
  if (stated.codec_id != AV_CODEC_ID_H264 && stated.codec_id != AV_CODEC_ID_HEVC) {
    throw wrong_kind(header.codec);
  }
  header.setup.assign(stated.extradata, stated.extradata + stated.extradata_size);
  codec = decoder_of(header);
  parser.reset(av_parser_init(stated.codec_id));
  if (!codec || !parser) {
    throw NetworkFault("cannot be read by this build of FFmpeg", "install libavcodec", true);
  }
  parser->flags |= PARSER_FLAG_COMPLETE_FRAMES;
}

/// The next part of a picture of our stream.
void RtspPictures::Impl::read_part() {
  while (true) {
    av_packet_unref(part.get());
    const int status = av_read_frame(input.get(), part.get());
    if (status == AVERROR(EAGAIN)) continue;
    const bool is_silent = status < 0 && gives_up();
    if (is_silent && skipped > 0) {
      throw NetworkFault("sends no picture that can be decoded by itself",
                         "set its interval of key frames to a second or two", false);
    }
    if (is_silent) {
      throw NetworkFault("sends no images", "check that it is switched on and in reach", false);
    }
    if (status < 0) {
      throw NetworkFault("has ended the connection", "check that it is still switched on", false);
    }
    if (part->stream_index == stream_index && part->size > 0) return;
  }
}

/// Joins the parts that have one stamp. The picture at hand when the connection ends may lack some,
/// which its decoder finds out.
void RtspPictures::Impl::read_picture() {
  if (ended) throw NetworkFault(*ended);
  av_packet_unref(picture.get());
  while (true) {
    try {
      if (!has_part) read_part();
    } catch (const NetworkFault& fault) {
      if (picture->size == 0) throw;
      ended = fault;
      return;
    }
    const bool is_next = part->pts != AV_NOPTS_VALUE && part->pts != picture->pts;
    has_part = picture->size > 0 && is_next;
    if (has_part) return;
    const int begin = picture->size;
    if (begin + std::int64_t{part->size} > kMostPictureBytes) {
      throw NetworkFault("sends images of impossible size", "check its settings", true);
    }
    if (av_grow_packet(picture.get(), part->size) < 0) throw std::bad_alloc();
    std::copy_n(part->data, part->size, picture->data + begin);
    if (is_next) picture->pts = part->pts;
  }
}

/// Whether `picture` can be decoded without those before it. To be asked once of each.
bool RtspPictures::Impl::is_key() {
  std::uint8_t* parsed = nullptr;
  int parsed_size = 0;
  av_parser_parse2(parser.get(), codec.get(), &parsed, &parsed_size, picture->data, picture->size,
                   picture->pts, AV_NOPTS_VALUE, -1);
  return parser->key_frame == 1;
}

/// Whether a recording can begin with this picture, which needs no others.
bool RtspPictures::Impl::is_start() {
  auto within = setup_within(*picture, *stream().codecpar);
  if (!within.empty()) header.setup = std::move(within);
  const auto decoded = decoded_size(*picture, header);
  size = decoded.value_or(ImageSize{});
  return decoded.has_value();
}

void RtspPictures::Impl::wait_for_start() {
  for (int undecodable = 0; undecodable <= kMostUndecodable;) {
    read_picture();
    const bool should_be = is_key();
    if (should_be && is_start()) {
      skipped = 0;
      return;
    }
    ++skipped;
    undecodable += should_be ? 1 : 0;
  }
  throw NetworkFault("sends images that cannot be decoded", "set it to H.264", true);
}

RtspPictures::RtspPictures(const std::string& address, std::function<bool()> gives_up)
    : impl_(std::make_unique<Impl>()) {
  impl_->gives_up = std::move(gives_up);
  impl_->connect(address);
  impl_->choose_stream();
  impl_->wait_for_start();
  impl_->has_first = true;
}

RtspPictures::~RtspPictures() = default;

const VideoHeader& RtspPictures::header() const {
  return impl_->header;
}

bool RtspPictures::next(NetworkImage& image) {
  const bool is_first = std::exchange(impl_->has_first, false);
  if (!is_first) impl_->read_picture();
  const AVPacket& picture = *impl_->picture;
  image.bytes.clear();
  if (is_first) image.bytes = impl_->header.setup;
  image.bytes.insert(image.bytes.end(), picture.data, picture.data + picture.size);
  image.size = impl_->size;
  image.is_key = is_first || impl_->is_key();
  image.stamp_s.reset();
  if (picture.pts != AV_NOPTS_VALUE) {
    image.stamp_s = static_cast<double>(picture.pts) * av_q2d(impl_->stream().time_base);
  }
  return true;
}

}  // namespace sheen::capture
