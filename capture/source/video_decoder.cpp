// SPDX-License-Identifier: MIT
#include "capture/source/video_decoder.h"

#include "capture/source/ffmpeg_owners.h"
#include "core/diagnostics/error.h"

extern "C" {
#include <libavutil/display.h>
}

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <limits>
#include <set>
#include <string>

namespace sheen::capture {
namespace {

constexpr double kMostStatedFrames = 1e8;
constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;
constexpr std::uint64_t kMostBoxBytes = std::uint64_t{1} << 48;
constexpr int kBytesAtOnce = 1 << 15;
constexpr std::size_t kMostPending = 256;  // packets whose picture is not out yet
constexpr int kMostFaults = 1000;  // in a row, without a packet: the decoder has lost itself

core::Error undecodable(const std::filesystem::path& path) {
  return core::bad_input(path, "cannot be decoded as a video", "check that it is one and complete");
}

/// The bytes of a growing video, as FFmpeg reads them; nothing may be thrown through FFmpeg.
struct GrowingInput {
  VideoBytes* bytes = nullptr;
  std::exception_ptr fault;
  BytesOfOursPtr context;

  static int read(void* opaque, std::uint8_t* bytes, int count) {
    auto& self = *static_cast<GrowingInput*>(opaque);
    try {
      const std::size_t taken = self.bytes->read({bytes, static_cast<std::size_t>(count)});
      return taken > 0 ? static_cast<int>(taken) : AVERROR_EOF;
    } catch (...) {
      self.fault = std::current_exception();
      return AVERROR_EXTERNAL;
    }
  }

  void rethrow() const {
    if (fault) std::rethrow_exception(fault);
  }
};

/// Whether a file of ISO boxes (MP4, MOV) ends before its index: recorders write that last.
bool lacks_index(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::uint64_t begin = 0;
  for (;;) {
    std::array<unsigned char, 16> header{};
    file.seekg(static_cast<std::streamoff>(begin));
    if (!file.read(reinterpret_cast<char*>(header.data()), 8)) return begin > 0;
    const auto number_at = [&](std::size_t first, std::size_t count) {
      std::uint64_t number = 0;
      for (std::size_t i = first; i < first + count; ++i) number = number << 8 | header[i];
      return number;
    };
    const std::string kind(header.begin() + 4, header.begin() + 8);
    if (kind == "moov" || (begin == 0 && kind != "ftyp")) return false;
    std::uint64_t size = number_at(0, 4);
    if (size == 1 && file.read(reinterpret_cast<char*>(header.data()) + 8, 8)) {
      size = number_at(8, 8);
    }
    // 0 is a box up to the end of the file; smaller ones than their header are none.
    if (size < 8 || size > kMostBoxBytes) return size == 0;
    begin += size;
  }
}

core::Error unreadable(const std::filesystem::path& path) {
  std::error_code no_throw;
  if (std::filesystem::file_size(path, no_throw) == 0) {
    return core::bad_input(path, "is empty", "copy or record it again");
  }
  if (!lacks_index(path)) return undecodable(path);
  return core::bad_input(path, "the recording was not finished: no index (moov)",
                         "copy it again if the copy was cut short; else mend it from an intact "
                         "recording of this camera (untrunc), or record again");
}

/// `growing` null: the file itself.
InputPtr open_input(const std::filesystem::path& path, GrowingInput* growing) {
  // Faults of files are told by us, in one line.
  av_log_set_level(AV_LOG_QUIET);
  AVFormatContext* context = avformat_alloc_context();
  if (context == nullptr) throw std::bad_alloc();
  // With the protocol before it a colon in the name is a letter like any other.
  std::string name = "file:" + path.string();
  if (growing != nullptr) {
    growing->context.reset(avio_alloc_context(static_cast<std::uint8_t*>(av_malloc(kBytesAtOnce)),
                                              kBytesAtOnce, 0, growing, &GrowingInput::read,
                                              nullptr, nullptr));
    context->pb = growing->context.get();
    name.clear();
  }
  AVDictionary* options = nullptr;
  av_dict_set(&options, "protocol_whitelist", "file", 0);
  const int status = avformat_open_input(&context, name.c_str(), nullptr, &options);
  av_dict_free(&options);
  if (growing != nullptr) growing->rethrow();
  if (status < 0) throw growing != nullptr ? undecodable(path) : unreadable(path);
  InputPtr input(context);
  if (avformat_find_stream_info(context, nullptr) < 0) throw undecodable(path);
  return input;
}

/// What a file holds in place of a video.
std::string other_streams(const AVFormatContext& input) {
  for (unsigned i = 0; i < input.nb_streams; ++i) {
    if (input.streams[i]->codecpar->codec_type == AVMEDIA_TYPE_AUDIO) return ", but sound";
  }
  return {};
}

/// Number of the video stream whose pictures have the wanted size, upright or turned; FFmpeg's
/// choice where none or several have.
int wanted_stream(const AVFormatContext& input, const std::optional<ImageSize>& wanted) {
  int found = -1;
  for (unsigned i = 0; wanted && i < input.nb_streams; ++i) {
    const AVStream& stream = *input.streams[i];
    const AVCodecParameters& stated = *stream.codecpar;
    const bool is_picture = (stream.disposition & AV_DISPOSITION_ATTACHED_PIC) != 0;
    if (stated.codec_type != AVMEDIA_TYPE_VIDEO || is_picture) continue;
    if (!(ImageSize{stated.width, stated.height} == *wanted) &&
        !(ImageSize{stated.height, stated.width} == *wanted)) {
      continue;
    }
    if (found >= 0) return -1;
    found = static_cast<int>(i);
  }
  return found;
}

/// For a few images FFmpeg takes the ticks of the container's clock for a rate, 1000 in Matroska.
std::optional<double> usable_rate(AVRational rate, AVRational tick) {
  constexpr double fastest_camera = 500;
  const double fps = rate.den != 0 ? av_q2d(rate) : 0;
  const bool is_clock = fps > fastest_camera && fps * av_q2d(tick) > 0.99;
  return std::isfinite(fps) && fps > 0.01 && fps < 1e4 && !is_clock ? std::optional(fps)
                                                                    : std::nullopt;
}

Orientation orientation_of(const AVStream& stream) {
  std::size_t size = 0;
  const auto* bytes = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, &size);
  Orientation orientation;
  if (bytes == nullptr || size < 9 * sizeof(std::int32_t)) return orientation;
  std::int32_t matrix[9];
  std::memcpy(matrix, bytes, sizeof(matrix));
  // A negative determinant mirrors. FFmpeg's flip takes a mirror out that comes after the turn; the
  // turn the other way round, after the mirror, is the same.
  const double determinant =
      static_cast<double>(matrix[0]) * matrix[4] - static_cast<double>(matrix[1]) * matrix[3];
  if (determinant < 0) {
    orientation.is_mirrored = true;
    av_display_matrix_flip(matrix, 1, 0);
  }
  const double counter_clockwise = av_display_rotation_get(matrix);
  if (!std::isfinite(counter_clockwise)) return {};
  const long quarters =
      std::lround((orientation.is_mirrored ? counter_clockwise : -counter_clockwise) / 90);
  orientation.clockwise_degrees = static_cast<int>(((quarters % 4) + 4) % 4) * 90;
  return orientation;
}

double pixel_aspect_of(AVFormatContext& input, AVStream& stream) {
  constexpr double widest = 4;
  const AVRational stated = av_guess_sample_aspect_ratio(&input, &stream, nullptr);
  const double aspect = stated.num > 0 && stated.den > 0 ? av_q2d(stated) : 1;
  return aspect > 1 / widest && aspect < widest ? aspect : 1;
}

/// Pictures that a player shows, as far as the container knows without decoding.
std::optional<int> shown_pictures(const AVFormatContext& input, AVStream& stream,
                                  std::optional<double> fps) {
  double count = static_cast<double>(stream.nb_frames);
  // MP4's index lists every picture, with marks on those that an edit list hides.
  if (std::strstr(input.iformat->name, "mov") != nullptr) {
    const int entries = avformat_index_get_entries_count(&stream);
    int shown = 0;
    for (int i = 0; i < entries; ++i) {
      const AVIndexEntry* entry = avformat_index_get_entry(&stream, i);
      shown += (entry->flags & AVINDEX_DISCARD_FRAME) == 0 ? 1 : 0;
    }
    if (entries > 0 && shown > 0) count = std::min(count > 0 ? count : shown, double(shown));
  }
  if (count <= 0 && fps) {
    const double seconds = stream.duration != AV_NOPTS_VALUE
                               ? static_cast<double>(stream.duration) * av_q2d(stream.time_base)
                           : input.duration != AV_NOPTS_VALUE
                               ? static_cast<double>(input.duration) / AV_TIME_BASE
                               : 0;
    count = std::floor(seconds * *fps + 0.5);
  }
  return count >= 1 && count < kMostStatedFrames ? std::optional(static_cast<int>(count))
                                                 : std::nullopt;
}

}  // namespace

struct VideoDecoder::Impl {
  Impl(const std::filesystem::path& video, VideoBytes* bytes,
       const std::optional<ImageSize>& wanted);

  bool decode();
  void read_packet();
  bool feed();
  void note_packet();
  void place_picture();
  void fill_in_colours();

  std::filesystem::path path;
  GrowingInput growing;
  InputPtr input;
  int stream_index = -1;
  CodecPtr codec;
  PacketPtr packet{av_packet_alloc()};
  FramePtr frame{av_frame_alloc()};
  VideoFacts facts;
  bool has_packet = false;  ///< `packet` is read, but not with the decoder yet
  bool is_draining = false;
  bool has_ended = false;
  bool counts_packets = true;      ///< one packet is one picture
  std::set<std::int64_t> pending;  ///< stamps of packets whose picture is not out yet
  int pictures = 0;                ///< that came out or were lost
  int damaged = 0;
  int index = -1;
  double first_s = 0;
  double time_s = 0;
};

VideoDecoder::Impl::Impl(const std::filesystem::path& video, VideoBytes* bytes,
                         const std::optional<ImageSize>& wanted)
    : path(video), growing{bytes, {}, {}}, input(open_input(video, bytes ? &growing : nullptr)) {
  const AVCodec* decoder = nullptr;
  stream_index = av_find_best_stream(input.get(), AVMEDIA_TYPE_VIDEO, wanted_stream(*input, wanted),
                                     -1, &decoder, 0);
  if (stream_index == AVERROR_STREAM_NOT_FOUND) {
    throw core::bad_input(path, "holds no video" + other_streams(*input), "name the recording");
  }
  if (stream_index < 0 || decoder == nullptr || !packet || !frame) throw undecodable(path);
  AVStream& stream = *input->streams[stream_index];
  for (unsigned i = 0; i < input->nb_streams; ++i) {
    if (static_cast<int>(i) != stream_index) input->streams[i]->discard = AVDISCARD_ALL;
  }
  codec.reset(avcodec_alloc_context3(decoder));
  if (!codec || avcodec_parameters_to_context(codec.get(), stream.codecpar) < 0) {
    throw undecodable(path);
  }
  codec->pkt_timebase = stream.time_base;
  codec->max_pixels = kMostPixels;
  codec->thread_count = 0;
  // Of several pictures at once the damage is found now in time, now too late: what is left out
  // would be up to chance. Slices at once are safe: two threads cost 10 % more CPU than one where a
  // picture has four (H.264, 1440 x 1080: 9.4 for 8.5 ms), nothing where it has one (8.6 for 8.6).
  codec->thread_type = FF_THREAD_SLICE;
  if (avcodec_open2(codec.get(), decoder, nullptr) < 0) throw undecodable(path);
  facts.size = {stream.codecpar->width, stream.codecpar->height};
  facts.fps = usable_rate(stream.avg_frame_rate, stream.time_base);
  if (!facts.fps) facts.fps = usable_rate(stream.r_frame_rate, stream.time_base);
  facts.frames = shown_pictures(*input, stream, facts.fps);
  facts.orientation = orientation_of(stream);
  facts.pixel_aspect = pixel_aspect_of(*input, stream);
  // AVI states a rate and counts; the other containers stamp every picture.
  facts.has_own_times = std::strcmp(input->iformat->name, "avi") != 0;
  const AVFieldOrder order = stream.codecpar->field_order;
  counts_packets =
      facts.has_own_times && (order == AV_FIELD_UNKNOWN || order == AV_FIELD_PROGRESSIVE);
}

void VideoDecoder::Impl::note_packet() {
  if (packet->pts == AV_NOPTS_VALUE) counts_packets = false;
  // The reference pictures of VP8 that are never shown: bit 4 of the frame tag is show_frame.
  const bool is_hidden =
      codec->codec_id == AV_CODEC_ID_VP8 && packet->size > 0 && (packet->data[0] & 0x10) == 0;
  if (counts_packets && !is_hidden && (packet->flags & AV_PKT_FLAG_DISCARD) == 0 &&
      packet->size > 0) {
    pending.insert(packet->pts);
  }
  if (pending.size() > kMostPending) counts_packets = false;
  if (!counts_packets) pending.clear();
}

/// Reads the next packet of our stream; at the end there is none.
void VideoDecoder::Impl::read_packet() {
  while (true) {
    const int status = av_read_frame(input.get(), packet.get());
    if (status == AVERROR(EAGAIN)) continue;
    has_packet = status >= 0;
    if (!has_packet || packet->stream_index == stream_index) break;
    av_packet_unref(packet.get());
  }
  if (has_packet) note_packet();
}

/// Gives the decoder the next packet, or the end; false after the end. A packet that the decoder
/// does not take yet is kept for the next call.
bool VideoDecoder::Impl::feed() {
  if (is_draining) return false;
  if (!has_packet) read_packet();
  is_draining = !has_packet;
  const int status = avcodec_send_packet(codec.get(), has_packet ? packet.get() : nullptr);
  if (status == AVERROR(EAGAIN)) return true;
  // What cannot be decoded gives no picture; the next one may.
  av_packet_unref(packet.get());
  has_packet = false;
  return true;
}

void VideoDecoder::Impl::fill_in_colours() {
  const AVCodecParameters& stated = *input->streams[stream_index]->codecpar;
  if (frame->colorspace == AVCOL_SPC_UNSPECIFIED) frame->colorspace = stated.color_space;
  if (frame->color_range == AVCOL_RANGE_UNSPECIFIED) frame->color_range = stated.color_range;
  if (frame->color_primaries == AVCOL_PRI_UNSPECIFIED) {
    frame->color_primaries = stated.color_primaries;
  }
  if (frame->color_trc == AVCOL_TRC_UNSPECIFIED) frame->color_trc = stated.color_trc;
}

/// Index and time. Packets before this picture whose own never came out were damaged ones.
void VideoDecoder::Impl::place_picture() {
  const std::int64_t stamp = frame->best_effort_timestamp;
  int lost = 0;
  if (counts_packets && stamp != AV_NOPTS_VALUE) {
    while (!pending.empty() && *pending.begin() < stamp) {
      pending.erase(pending.begin());
      ++lost;
    }
    pending.erase(stamp);
  }
  const bool is_first = index < 0;
  // What precedes the first picture cannot be decoded by anybody: leading pictures of a cut.
  if (!is_first) {
    pictures += lost;
    damaged += lost;
  }
  index = pictures++;
  const double stamp_s =
      stamp == AV_NOPTS_VALUE
          ? std::nan("")
          : static_cast<double>(stamp) * av_q2d(input->streams[stream_index]->time_base);
  if (is_first) {
    first_s = std::isfinite(stamp_s) ? stamp_s : 0;
    time_s = 0;
    return;
  }
  // Some containers carry no times; then the frames are evenly spaced.
  const double since_first_s = stamp_s - first_s;
  const bool advances = std::isfinite(since_first_s) && since_first_s > time_s;
  time_s = advances ? since_first_s : time_s + (1 + lost) / facts.fps.value_or(30);
}

bool VideoDecoder::Impl::decode() {
  int faults = 0;
  while (!has_ended) {
    const int status = avcodec_receive_frame(codec.get(), frame.get());
    if (status == 0) {
      place_picture();
      if ((frame->flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame->decode_error_flags != 0) {
        ++damaged;
        continue;
      }
      fill_in_colours();
      return true;
    }
    if (status == AVERROR(EAGAIN)) {
      faults = 0;
      has_ended = !feed();
    } else {
      // Any other fault is one picture's; those that are ready come first, then the next packet.
      has_ended = status == AVERROR_EOF || ++faults > kMostFaults;
    }
  }
  growing.rethrow();
  // Packets whose picture never came.
  damaged += index < 0 ? 0 : static_cast<int>(pending.size());
  pending.clear();
  return false;
}

VideoDecoder::VideoDecoder(const std::filesystem::path& path,
                           const std::optional<ImageSize>& wanted)
    : impl_(std::make_unique<Impl>(path, nullptr, wanted)) {}

VideoDecoder::VideoDecoder(const std::filesystem::path& name, VideoBytes& bytes)
    : impl_(std::make_unique<Impl>(name, &bytes, std::nullopt)) {}

VideoDecoder::~VideoDecoder() = default;
VideoDecoder::VideoDecoder(VideoDecoder&&) noexcept = default;
VideoDecoder& VideoDecoder::operator=(VideoDecoder&&) noexcept = default;

const VideoFacts& VideoDecoder::facts() const {
  return impl_->facts;
}

bool VideoDecoder::next() {
  return impl_->decode();
}

const AVFrame& VideoDecoder::picture() const {
  return *impl_->frame;
}

int VideoDecoder::index() const {
  return impl_->index;
}

double VideoDecoder::time_s() const {
  return impl_->time_s;
}

int VideoDecoder::damaged() const {
  return impl_->damaged;
}

}  // namespace sheen::capture
