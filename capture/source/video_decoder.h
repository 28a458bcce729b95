// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"
#include "capture/source/quarter_turn.h"
#include "capture/source/video_bytes.h"

#include <filesystem>
#include <memory>
#include <optional>

struct AVFrame;

namespace sheen::capture {

/// What a video's container says.
struct VideoFacts {
  ImageSize size;             ///< of the stored pixels; 0 where only the images tell
  std::optional<double> fps;  ///< usual frame rate
  std::optional<int> frames;  ///< that a player shows: those hidden by an edit list do not count
  Orientation orientation;
  double pixel_aspect = 1;     ///< width of a pixel over its height
  bool has_own_times = false;  ///< frames carry times of their own, not only a rate
};

/// Pictures of a video file by FFmpeg, as they are stored: neither turned nor converted. Only local
/// files are opened, whatever a file refers to.
class VideoDecoder {
 public:
  /// Of several video streams the only one of the `wanted` size, else FFmpeg's choice. Throws
  /// core::Error (bad_input) for what cannot be decoded.
  explicit VideoDecoder(const std::filesystem::path& path,
                        const std::optional<ImageSize>& wanted = std::nullopt);
  /// Of a video that still grows, called `name` in messages; `bytes` is borrowed. Waits until there
  /// is enough to know the video. What `bytes` throws is thrown here and by `next`.
  VideoDecoder(const std::filesystem::path& name, VideoBytes& bytes);
  ~VideoDecoder();
  VideoDecoder(VideoDecoder&&) noexcept;
  VideoDecoder& operator=(VideoDecoder&&) noexcept;
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  [[nodiscard]] const VideoFacts& facts() const;

  /// Decodes the next picture that is whole; false at the end.
  bool next();

  /// The picture decoded last; valid until the next call. Colour facts that its coding leaves open
  /// are filled in from the container.
  [[nodiscard]] const AVFrame& picture() const;
  /// Its place in the recording, counted from 0; damaged pictures before it count.
  [[nodiscard]] int index() const;
  /// Its time, seconds after the first picture.
  [[nodiscard]] double time_s() const;

  /// Pictures so far that were damaged and are left out.
  [[nodiscard]] int damaged() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::capture
