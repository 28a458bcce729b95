// SPDX-License-Identifier: MIT
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <memory>

namespace sheen::capture {

/// Owners of what FFmpeg's libraries make.
struct CloseInput {
  void operator()(AVFormatContext* input) const { avformat_close_input(&input); }
};
struct CloseBytes {
  void operator()(AVIOContext* bytes) const { avio_closep(&bytes); }
};
/// Of avio_alloc_context, which FFmpeg never frees.
struct FreeBytesOfOurs {
  void operator()(AVIOContext* bytes) const {
    av_freep(&bytes->buffer);
    avio_context_free(&bytes);
  }
};
struct FreeCodec {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
};
struct FreeFrame {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
using InputPtr = std::unique_ptr<AVFormatContext, CloseInput>;
using BytesPtr = std::unique_ptr<AVIOContext, CloseBytes>;
using BytesOfOursPtr = std::unique_ptr<AVIOContext, FreeBytesOfOurs>;
using CodecPtr = std::unique_ptr<AVCodecContext, FreeCodec>;
using FramePtr = std::unique_ptr<AVFrame, FreeFrame>;
using PacketPtr = std::unique_ptr<AVPacket, FreePacket>;

}  // namespace sheen::capture
