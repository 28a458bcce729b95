// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_modes.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <tuple>

namespace sheen::capture {
namespace {

constexpr ImageSize preferred_size{1280, 720};

/// Tried where a driver gives a range of sizes instead of a list.
constexpr std::array common_sizes{
    ImageSize{320, 240},  ImageSize{640, 480},   ImageSize{800, 600},   ImageSize{1280, 720},
    ImageSize{1280, 960}, ImageSize{1920, 1080}, ImageSize{2560, 1440}, ImageSize{3840, 2160}};

/// A driver that never says "that was the last" must not hold the program.
constexpr __u32 most_entries = 256;
constexpr __u32 most_bytes_per_line = 1U << 20;

double rate(const v4l2_fract& interval_s) {
  return interval_s.numerator == 0 ? 0.0
                                   : static_cast<double>(interval_s.denominator) /
                                         static_cast<double>(interval_s.numerator);
}

bool in_range(__u32 value, __u32 smallest, __u32 largest, __u32 step) {
  return value >= smallest && value <= largest && (step <= 1 || (value - smallest) % step == 0);
}

std::vector<ImageSize> sizes(const V4l2Device& device, __u32 pixel_format) {
  std::vector<ImageSize> found;
  for (__u32 index = 0; index < most_entries; ++index) {
    v4l2_frmsizeenum entry{};
    entry.index = index;
    entry.pixel_format = pixel_format;
    if (device.request(VIDIOC_ENUM_FRAMESIZES, &entry) != 0) break;
    if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      found.push_back(
          {static_cast<int>(entry.discrete.width), static_cast<int>(entry.discrete.height)});
      continue;
    }
    for (const ImageSize& size : common_sizes)
      if (in_range(static_cast<__u32>(size.width_px), entry.stepwise.min_width,
                   entry.stepwise.max_width, entry.stepwise.step_width) &&
          in_range(static_cast<__u32>(size.height_px), entry.stepwise.min_height,
                   entry.stepwise.max_height, entry.stepwise.step_height))
        found.push_back(size);
    break;
  }
  std::erase_if(found, [](const ImageSize& size) {
    return size.width_px <= 0 || size.height_px <= 0 || size.width_px > 16384 ||
           size.height_px > 16384;
  });
  return found;
}

std::vector<double> rates(const V4l2Device& device, __u32 pixel_format, const ImageSize& size) {
  std::vector<double> found;
  for (__u32 index = 0; index < most_entries; ++index) {
    v4l2_frmivalenum entry{};
    entry.index = index;
    entry.pixel_format = pixel_format;
    entry.width = static_cast<__u32>(size.width_px);
    entry.height = static_cast<__u32>(size.height_px);
    if (device.request(VIDIOC_ENUM_FRAMEINTERVALS, &entry) != 0) break;
    if (entry.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      found.push_back(rate(entry.discrete));
      continue;
    }
    // A range: its ends, and the usual rates between them.
    const double fastest = rate(entry.stepwise.min);
    const double slowest = rate(entry.stepwise.max);
    found.push_back(fastest);
    for (const double fps : {60.0, 30.0, 25.0, 15.0})
      if (fps < fastest && fps >= slowest) found.push_back(fps);
    break;
  }
  if (found.empty()) found.push_back(0);
  return found;
}

/// How far a rate is from what is asked for.
double rate_distance(double fps, const ModeWish& wish) {
  return wish.fps ? std::abs(fps - *wish.fps) : -fps;
}

double size_distance(const ImageSize& size, const ModeWish& wish) {
  if (wish.size) return 0;
  const auto off = [](int value, int preferred) {
    return std::abs(std::log(static_cast<double>(value) / preferred));
  };
  return off(size.width_px, preferred_size.width_px) +
         off(size.height_px, preferred_size.height_px);
}

int bytes_rank(PixelFormat format) {
  switch (format) {
    case PixelFormat::mjpeg:
      return 0;
    case PixelFormat::nv12:
      return 1;
    case PixelFormat::yuyv:
      return 2;
    case PixelFormat::video:
      break;
  }
  return 3;
}

/// Undoes what an earlier program may have left: a part of the image cut out or drawn smaller.
/// Most cameras know nothing of this, which is as good.
void reset_selection(const V4l2Device& device, __u32 target, __u32 whole) {
  v4l2_selection selection{};
  selection.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  selection.target = whole;
  if (device.request(VIDIOC_G_SELECTION, &selection) != 0) return;
  selection.target = target;
  static_cast<void>(device.request(VIDIOC_S_SELECTION, &selection));
}

double set_rate(const V4l2Device& device, double fps) {
  v4l2_streamparm wanted{};
  wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (device.request(VIDIOC_G_PARM, &wanted) != 0) return 0;
  if (fps > 0 && (wanted.parm.capture.capability & V4L2_CAP_TIMEPERFRAME)) {
    wanted.parm.capture.timeperframe = {1000, static_cast<__u32>(std::lround(fps * 1000))};
    // Not every camera lets its rate be set: what it says afterwards counts.
    if (device.request(VIDIOC_S_PARM, &wanted) != 0) return 0;
  }
  return rate(wanted.parm.capture.timeperframe);
}

/// Refuses a driver that changed its mind.
void check_mode(const V4l2Device& device, const v4l2_pix_format& set, const CameraMode& mode) {
  std::string fault;
  if (pixel_format(set.pixelformat) != mode.format)
    fault = "another format";
  else if (set.width != static_cast<__u32>(mode.size.width_px) ||
           set.height != static_cast<__u32>(mode.size.height_px))
    fault = std::to_string(set.width) + "x" + std::to_string(set.height);
  else if (set.field != V4L2_FIELD_NONE && set.field != V4L2_FIELD_ANY)
    fault = "interlaced images";
  else if (mode.format != PixelFormat::mjpeg && set.bytesperline > most_bytes_per_line)
    fault = "impossibly long lines";
  if (fault.empty()) return;
  throw V4l2Error(core::Error::Kind::run_failed, device.node(),
                  "asked for " + format_name(mode.format) + " " +
                      std::to_string(mode.size.width_px) + "x" +
                      std::to_string(mode.size.height_px) + ", the driver sets " + fault,
                  "choose another size or format");
}

/// Where the lines of a raw image lie. Drivers that leave the length of a line out pack tightly.
ActiveMode with_layout(ActiveMode active, int driver_bytes_per_line) {
  if (active.mode.format == PixelFormat::mjpeg) return active;
  const ImageSize& size = active.mode.size;
  const bool planar = active.mode.format == PixelFormat::nv12;
  active.bytes_per_line =
      std::max(driver_bytes_per_line, planar ? size.width_px : 2 * size.width_px);
  const int lines = planar ? size.height_px + (size.height_px + 1) / 2 : size.height_px;
  active.least_bytes =
      static_cast<std::size_t>(active.bytes_per_line) * static_cast<std::size_t>(lines);
  return active;
}

}  // namespace

std::uint32_t fourcc(PixelFormat format) {
  switch (format) {
    case PixelFormat::mjpeg:
      return V4L2_PIX_FMT_MJPEG;
    case PixelFormat::yuyv:
      return V4L2_PIX_FMT_YUYV;
    case PixelFormat::nv12:
      return V4L2_PIX_FMT_NV12;
    case PixelFormat::video:
      break;
  }
  return 0;
}

std::optional<PixelFormat> pixel_format(std::uint32_t fourcc) {
  switch (fourcc) {
    case V4L2_PIX_FMT_MJPEG:
      return PixelFormat::mjpeg;
    case V4L2_PIX_FMT_YUYV:
      return PixelFormat::yuyv;
    case V4L2_PIX_FMT_NV12:
      return PixelFormat::nv12;
    default:
      return std::nullopt;
  }
}

std::string format_name(PixelFormat format) {
  switch (format) {
    case PixelFormat::mjpeg:
      return "MJPG";
    case PixelFormat::yuyv:
      return "YUYV";
    case PixelFormat::nv12:
      return "NV12";
    case PixelFormat::video:
      break;
  }
  return "?";
}

std::vector<CameraMode> camera_modes(const V4l2Device& device) {
  std::vector<CameraMode> modes;
  for (__u32 index = 0; index < most_entries; ++index) {
    v4l2_fmtdesc entry{};
    entry.index = index;
    entry.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (device.request(VIDIOC_ENUM_FMT, &entry) != 0) break;
    const auto format = pixel_format(entry.pixelformat);
    if (!format) continue;
    for (const ImageSize& size : sizes(device, entry.pixelformat))
      for (const double fps : rates(device, entry.pixelformat, size)) {
        const CameraMode mode{*format, size, fps};
        if (std::find(modes.begin(), modes.end(), mode) == modes.end()) modes.push_back(mode);
      }
  }
  return modes;
}

std::optional<CameraMode> choose_mode(const std::vector<CameraMode>& modes, const ModeWish& wish) {
  const auto badness = [&](const CameraMode& mode) {
    return std::tuple(size_distance(mode.size, wish), rate_distance(mode.fps, wish),
                      bytes_rank(mode.format));
  };
  std::optional<CameraMode> best;
  for (const CameraMode& mode : modes) {
    if (wish.format && mode.format != *wish.format) continue;
    if (wish.size &&
        (mode.size.width_px != wish.size->width_px || mode.size.height_px != wish.size->height_px))
      continue;
    if (!best || badness(mode) < badness(*best)) best = mode;
  }
  return best;
}

ActiveMode set_mode(const V4l2Device& device, const CameraMode& mode) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<__u32>(mode.size.width_px);
  format.fmt.pix.height = static_cast<__u32>(mode.size.height_px);
  format.fmt.pix.pixelformat = fourcc(mode.format);
  format.fmt.pix.field = V4L2_FIELD_NONE;
  reset_selection(device, V4L2_SEL_TGT_CROP, V4L2_SEL_TGT_CROP_DEFAULT);
  device.require(VIDIOC_S_FMT, &format, "setting the image format");
  reset_selection(device, V4L2_SEL_TGT_COMPOSE, V4L2_SEL_TGT_COMPOSE_DEFAULT);
  check_mode(device, format.fmt.pix, mode);

  const double fps = set_rate(device, mode.fps);
  return with_layout({{mode.format, mode.size, fps}},
                     static_cast<int>(format.fmt.pix.bytesperline));
}

}  // namespace sheen::capture
