// SPDX-License-Identifier: MIT
#include "capture/files/video_writer.h"

#include "capture/source/ffmpeg_owners.h"
#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"

extern "C" {
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <cassert>
#include <string>

namespace sheen::capture {
namespace {

struct CloseOutput {
  void operator()(AVFormatContext* output) const {
    avio_closep(&output->pb);
    avformat_free_context(output);
  }
};
struct FreeScaler {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

const AVCodec* video_encoder() {
  const AVCodec* const h264 = avcodec_find_encoder_by_name("libx264");
  return h264 != nullptr ? h264 : avcodec_find_encoder(AV_CODEC_ID_MPEG4);
}

}  // namespace

struct VideoWriter::Impl {
  explicit Impl(const std::filesystem::path& file) : path(file), staged(file) {}

  /// Throws where FFmpeg says that something failed.
  void check(int result) const {
    if (result >= 0) return;
    throw core::Error(core::Error::Kind::run_failed, path, "the video could not be written",
                      "check free space and FFmpeg's encoders, or write pictures into a folder");
  }

  void open(const cv::Size& size, int fps);
  void encode(const AVFrame* picture);

  std::filesystem::path path;
  core::StagedOutput staged;
  std::unique_ptr<AVFormatContext, CloseOutput> output;
  CodecPtr codec;
  FramePtr frame;
  PacketPtr packet{av_packet_alloc()};
  std::unique_ptr<SwsContext, FreeScaler> scaler;
  std::int64_t count = 0;
};

void VideoWriter::Impl::open(const cv::Size& size, int fps) {
  av_log_set_level(AV_LOG_QUIET);  // faults are told by us, in one line
  // Said to be a file, whatever colons are in its name.
  const std::string name = "file:" + staged.path().string();
  AVFormatContext* made = nullptr;
  check(avformat_alloc_output_context2(&made, nullptr, "mp4", name.c_str()));
  output.reset(made);
  const AVCodec* const encoder = video_encoder();
  check(encoder == nullptr ? -1 : 0);
  codec.reset(avcodec_alloc_context3(encoder));
  codec->width = size.width;
  codec->height = size.height;
  codec->time_base = {1, fps};
  codec->framerate = {fps, 1};
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  codec->colorspace = AVCOL_SPC_BT709;
  codec->color_primaries = AVCOL_PRI_BT709;
  codec->color_trc = AVCOL_TRC_BT709;
  codec->color_range = AVCOL_RANGE_MPEG;
  codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (encoder->id == AV_CODEC_ID_H264) {
    av_opt_set(codec->priv_data, "crf", "16", 0);
  } else {
    codec->flags |= AV_CODEC_FLAG_QSCALE;
    codec->global_quality = 2 * FF_QP2LAMBDA;
  }
  check(avcodec_open2(codec.get(), encoder, nullptr));
  AVStream* const stream = avformat_new_stream(output.get(), nullptr);
  check(stream == nullptr ? -1 : 0);
  stream->time_base = codec->time_base;
  check(avcodec_parameters_from_context(stream->codecpar, codec.get()));
  check(avio_open(&output->pb, name.c_str(), AVIO_FLAG_WRITE));
  AVDictionary* options = nullptr;
  av_dict_set(&options, "movflags", "faststart", 0);  // a browser begins before it has all
  const int begun = avformat_write_header(output.get(), &options);
  av_dict_free(&options);
  check(begun);

  frame.reset(av_frame_alloc());
  frame->format = codec->pix_fmt;
  frame->width = size.width;
  frame->height = size.height;
  frame->colorspace = codec->colorspace;
  frame->color_range = codec->color_range;
  check(av_frame_get_buffer(frame.get(), 0));
  scaler.reset(sws_getContext(size.width, size.height, AV_PIX_FMT_BGR24, size.width, size.height,
                              codec->pix_fmt, SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP,
                              nullptr, nullptr, nullptr));
  check(scaler ? 0 : -1);
  const int* const bt709 = sws_getCoefficients(SWS_CS_ITU709);
  constexpr int one = 1 << 16;
  sws_setColorspaceDetails(scaler.get(), bt709, 1, bt709, 0, 0, one, one);
}

void VideoWriter::Impl::encode(const AVFrame* picture) {
  check(avcodec_send_frame(codec.get(), picture));
  while (true) {
    const int result = avcodec_receive_packet(codec.get(), packet.get());
    if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
    check(result);
    packet->stream_index = 0;
    packet->duration = 1;
    av_packet_rescale_ts(packet.get(), codec->time_base, output->streams[0]->time_base);
    check(av_interleaved_write_frame(output.get(), packet.get()));
  }
}

VideoWriter::VideoWriter(const std::filesystem::path& path, const cv::Size& size, int fps)
    : impl_(std::make_unique<Impl>(path)) {
  assert(size.width % 2 == 0 && size.height % 2 == 0 && fps > 0);
  impl_->open(size, fps);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const cv::Mat& image) {
  assert(image.type() == CV_8UC3);
  AVFrame& frame = *impl_->frame;
  impl_->check(av_frame_make_writable(&frame));
  const std::uint8_t* const rows[] = {image.data};
  const int strides[] = {static_cast<int>(image.step)};
  sws_scale(impl_->scaler.get(), rows, strides, 0, image.rows, frame.data, frame.linesize);
  frame.pts = impl_->count++;
  impl_->encode(&frame);
}

void VideoWriter::finish() {
  impl_->encode(nullptr);
  impl_->check(av_write_trailer(impl_->output.get()));
  impl_->check(avio_closep(&impl_->output->pb));
  impl_->staged.commit();
}

}  // namespace sheen::capture
