// SPDX-License-Identifier: MIT
#include "tests/capture/video_file.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/pixdesc.h>
}

#include <cmath>
#include <cstring>
#include <stdexcept>

namespace sheen::capture::test {
namespace {

constexpr std::int64_t kDuration_ms = 40;

void require(bool is_good, const char* what) {
  if (!is_good) throw std::runtime_error(std::string("cannot write the video: ") + what);
}

/// Y'CbCr of a colour, coded in `bits` bits: ITU-R BT.601, BT.709, BT.2020.
Eigen::Vector3i coded(const Eigen::Vector3d& rgb, const VideoSpec& spec, int bits) {
  double kr = 0.299, kb = 0.114;
  if (spec.matrix == AVCOL_SPC_BT709) kr = 0.2126, kb = 0.0722;
  if (spec.matrix == AVCOL_SPC_BT2020_NCL) kr = 0.2627, kb = 0.0593;
  const double y = kr * rgb[0] + (1 - kr - kb) * rgb[1] + kb * rgb[2];
  const double cb = (rgb[2] - y) / (2 * (1 - kb)), cr = (rgb[0] - y) / (2 * (1 - kr));
  const double scale = 1 << (bits - 8);
  const double top = (1 << bits) - 1;
  if (spec.is_full_range) {
    return {static_cast<int>(std::lround(top * y)),
            static_cast<int>(std::lround(top * cb + 128 * scale)),
            static_cast<int>(std::lround(top * cr + 128 * scale))};
  }
  return {static_cast<int>(std::lround(scale * (219 * y + 16))),
          static_cast<int>(std::lround(scale * (224 * cb + 128))),
          static_cast<int>(std::lround(scale * (224 * cr + 128)))};
}

void fill(AVFrame& frame, const VideoSpec& spec, int index) {
  const AVPixFmtDescriptor& format = *av_pix_fmt_desc_get(spec.format);
  const bool is_rgb = (format.flags & AV_PIX_FMT_FLAG_RGB) != 0;
  for (int plane = 0; plane < (is_rgb ? 1 : 3); ++plane) {
    const int shift_x = plane > 0 ? format.log2_chroma_w : 0;
    const int shift_y = plane > 0 ? format.log2_chroma_h : 0;
    for (int y = 0; y < spec.height >> shift_y; ++y) {
      std::uint8_t* const row = frame.data[plane] + y * frame.linesize[plane];
      for (int x = 0; x < spec.width >> shift_x; ++x) {
        const Eigen::Vector3d rgb = spec.colour(index, x >= spec.width >> shift_x >> 1);
        if (is_rgb) {
          for (int i = 0; i < 3; ++i) {
            row[3 * x + i] = static_cast<std::uint8_t>(std::lround(255 * rgb[i]));
          }
          continue;
        }
        const int value = coded(rgb, spec, format.comp[0].depth)[plane];
        if (format.comp[0].depth > 8) {
          const auto wide = static_cast<std::uint16_t>(value);
          std::memcpy(row + 2 * x, &wide, 2);
        } else {
          row[x] = static_cast<std::uint8_t>(value);
        }
      }
    }
  }
}

struct Writer {
  AVFormatContext* output = nullptr;
  AVCodecContext* codec = nullptr;
  AVFrame* frame = av_frame_alloc();
  AVPacket* packet = av_packet_alloc();

  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  Writer(Writer&&) = delete;
  Writer& operator=(Writer&&) = delete;
  ~Writer() {
    av_packet_free(&packet);
    av_frame_free(&frame);
    avcodec_free_context(&codec);
    if (output != nullptr) avio_closep(&output->pb);
    avformat_free_context(output);
  }
};

}  // namespace

void write_video(const std::filesystem::path& path, const VideoSpec& spec) {
  av_log_set_level(AV_LOG_QUIET);
  Writer writer;
  const std::string name = "file:" + path.string();
  require(avformat_alloc_output_context2(&writer.output, nullptr, nullptr, name.c_str()) >= 0,
          "container");
  const AVCodec* const encoder = avcodec_find_encoder(spec.codec);
  require(encoder != nullptr, "codec");
  AVCodecContext& codec = *(writer.codec = avcodec_alloc_context3(encoder));
  codec.width = spec.width;
  codec.height = spec.height;
  codec.pix_fmt = spec.format;
  codec.time_base = {1, 1000};
  codec.framerate = {25, 1};
  codec.gop_size = 12;
  if (spec.pixel_aspect) codec.sample_aspect_ratio = av_d2q(*spec.pixel_aspect, 1000);
  codec.global_quality = FF_QP2LAMBDA;
  codec.flags |= AV_CODEC_FLAG_QSCALE;
  codec.strict_std_compliance = FF_COMPLIANCE_UNOFFICIAL;
  if (spec.states_colours) {
    codec.colorspace = spec.matrix;
    codec.color_range = spec.is_full_range ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    codec.color_trc = spec.transfer;
    codec.color_primaries = spec.primaries;
  }
  if ((writer.output->oformat->flags & AVFMT_GLOBALHEADER) != 0) {
    codec.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  }
  require(avcodec_open2(&codec, encoder, nullptr) >= 0, "encoder");
  AVStream& stream = *avformat_new_stream(writer.output, nullptr);
  stream.time_base = codec.time_base;
  avcodec_parameters_from_context(stream.codecpar, &codec);
  stream.sample_aspect_ratio = codec.sample_aspect_ratio;
  if (spec.clockwise_degrees) {
    auto* const matrix = reinterpret_cast<std::int32_t*>(
        av_stream_new_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, 9 * sizeof(std::int32_t)));
    av_display_rotation_set(matrix, *spec.clockwise_degrees);
  }
  require(avio_open(&writer.output->pb, name.c_str(), AVIO_FLAG_WRITE) >= 0, "file");
  require(avformat_write_header(writer.output, nullptr) >= 0, "header");

  int written = 0;
  const auto take_packets = [&] {
    while (avcodec_receive_packet(&codec, writer.packet) >= 0) {
      if (spec.damaged.contains(written)) {
        // Its frame stays, so that parsers find the next one.
        const int half = writer.packet->size / 2;
        std::memset(writer.packet->data + half, 0, static_cast<std::size_t>(half - 16));
      }
      ++written;
      writer.packet->duration = kDuration_ms;
      av_packet_rescale_ts(writer.packet, codec.time_base, stream.time_base);
      require(av_interleaved_write_frame(writer.output, writer.packet) >= 0, "packet");
    }
  };
  for (std::size_t i = 0; i < spec.stamps_ms.size(); ++i) {
    AVFrame& frame = *writer.frame;
    av_frame_unref(&frame);
    frame.width = spec.width;
    frame.height = spec.height;
    frame.format = spec.format;
    require(av_frame_get_buffer(&frame, 0) >= 0, "memory");
    fill(frame, spec, static_cast<int>(i));
    frame.pts = spec.stamps_ms[i];
    frame.quality = codec.global_quality;
    require(avcodec_send_frame(&codec, &frame) >= 0, "frame");
    take_packets();
  }
  avcodec_send_frame(&codec, nullptr);
  take_packets();
  require(av_write_trailer(writer.output) >= 0, "trailer");
}

}  // namespace sheen::capture::test
