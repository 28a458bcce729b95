// SPDX-License-Identifier: MIT
#include "capture/source/video_colour.h"

#include "capture/source/light_curve.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <optional>
#include <tuple>

namespace sheen::capture {
namespace {

constexpr int kHighDefinition_px = 720;  // rows: recordings of that size are usually BT.709

struct FreeScaler {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

/// How one picture codes its colours.
struct Coding {
  int width = 0, height = 0;
  int format = -1;
  int matrix = 0;  ///< AVColorSpace
  bool is_full_range = false;
  LightCurve curve = LightCurve::srgb;
  WidePrimaries primaries = WidePrimaries::none;

  [[nodiscard]] auto tie() const {
    return std::tie(width, height, format, matrix, is_full_range, curve, primaries);
  }
  bool operator==(const Coding& other) const { return tie() == other.tie(); }
  [[nodiscard]] bool needs_light() const {
    return curve != LightCurve::srgb || primaries != WidePrimaries::none;
  }
};

bool has_luma(const AVPixFmtDescriptor& format) {
  return (format.flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) == 0 &&
         format.nb_components >= 3;
}

/// The old formats with a range of their own.
bool is_full_by_format(int format) {
  return format == AV_PIX_FMT_YUVJ420P || format == AV_PIX_FMT_YUVJ422P ||
         format == AV_PIX_FMT_YUVJ444P || format == AV_PIX_FMT_YUVJ440P ||
         format == AV_PIX_FMT_YUVJ411P;
}

/// libswscale's number of the matrix; nothing for one that it does not have.
std::optional<int> scaler_matrix(int matrix) {
  switch (matrix) {
    case AVCOL_SPC_UNSPECIFIED:
    case AVCOL_SPC_RESERVED:
    case AVCOL_SPC_RGB:
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
      return SWS_CS_ITU601;
    case AVCOL_SPC_BT709:
      return SWS_CS_ITU709;
    case AVCOL_SPC_FCC:
      return SWS_CS_FCC;
    case AVCOL_SPC_SMPTE240M:
      return SWS_CS_SMPTE240M;
    case AVCOL_SPC_BT2020_NCL:
      return SWS_CS_BT2020;
    default:
      return std::nullopt;
  }
}

std::optional<LightCurve> curve_of(int transfer) {
  switch (transfer) {
    case AVCOL_TRC_ARIB_STD_B67:
      return LightCurve::hlg;
    case AVCOL_TRC_SMPTE2084:
      return LightCurve::pq;
    case AVCOL_TRC_LINEAR:
      return LightCurve::linear;
    case AVCOL_TRC_LOG:
    case AVCOL_TRC_LOG_SQRT:
    case AVCOL_TRC_SMPTE428:
      return std::nullopt;
    default:
      return LightCurve::srgb;
  }
}

const char* text_of(const char* name) {
  return name != nullptr ? name : "?";
}

}  // namespace

struct VideoColour::Impl {
  std::unique_ptr<SwsContext, FreeScaler> scaler;
  std::optional<LightConverter> light;
  std::optional<Coding> coding;
  cv::Mat wide;  ///< CV_16UC3, rows padded
  cv::Mat rows;  ///< CV_8UC3, rows padded
  std::vector<std::string> notes;

  void note(const std::string& line) {
    if (std::find(notes.begin(), notes.end(), line) == notes.end()) notes.push_back(line);
  }

  [[nodiscard]] bool read_coding(const AVFrame& picture, Coding& found, std::string& fault);
  [[nodiscard]] bool prepare(const Coding& wanted);
  void note_coding(const AVFrame& picture, const Coding& found);
};

bool VideoColour::Impl::read_coding(const AVFrame& picture, Coding& found, std::string& fault) {
  const AVPixFmtDescriptor* format =
      av_pix_fmt_desc_get(static_cast<AVPixelFormat>(picture.format));
  if (format == nullptr || sws_isSupportedInput(static_cast<AVPixelFormat>(picture.format)) == 0) {
    fault = "has pictures in a pixel format that is not read";
    return false;
  }
  found.width = picture.width;
  found.height = picture.height;
  found.format = picture.format;
  if (has_luma(*format)) {
    if (!scaler_matrix(picture.colorspace)) {
      fault = std::string("codes its colours as ") +
              text_of(av_color_space_name(picture.colorspace)) + ", which is not read";
      return false;
    }
    found.matrix = picture.colorspace;
    found.is_full_range =
        picture.color_range == AVCOL_RANGE_JPEG || is_full_by_format(picture.format);
  }
  const auto curve = curve_of(picture.color_trc);
  if (!curve) {
    fault = std::string("codes light as ") + text_of(av_color_transfer_name(picture.color_trc)) +
            ", which is not read";
    return false;
  }
  found.curve = *curve;
  if (picture.color_primaries == AVCOL_PRI_BT2020) found.primaries = WidePrimaries::bt2020;
  if (picture.color_primaries == AVCOL_PRI_SMPTE432 ||
      picture.color_primaries == AVCOL_PRI_SMPTE431) {
    found.primaries = WidePrimaries::display_p3;
  }
  return true;
}

void VideoColour::Impl::note_coding(const AVFrame& picture, const Coding& found) {
  const AVPixFmtDescriptor* format =
      av_pix_fmt_desc_get(static_cast<AVPixelFormat>(picture.format));
  if (found.needs_light()) {
    std::string line = "its colours were converted to sRGB from primaries " +
                       std::string(text_of(av_color_primaries_name(picture.color_primaries))) +
                       ", transfer " + text_of(av_color_transfer_name(picture.color_trc));
    if (found.curve == LightCurve::hlg || found.curve == LightCurve::pq) {
      line += "; what is brighter than reference white is clipped";
    }
    note(line);
  }
  if (has_luma(*format) && picture.colorspace == AVCOL_SPC_UNSPECIFIED &&
      !is_full_by_format(picture.format) && picture.height >= kHighDefinition_px) {
    note(
        "does not say how its colours are coded; they are read as BT.601, high definition is "
        "usually BT.709");
  }
  if (picture.interlaced_frame != 0) {
    note("is interlaced: every image holds two moments in alternating lines; record progressive");
  }
}

bool VideoColour::Impl::prepare(const Coding& wanted) {
  coding.reset();
  const auto source = static_cast<AVPixelFormat>(wanted.format);
  const bool is_wide = wanted.needs_light();
  const int flags = SWS_BICUBIC | (is_wide ? SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT : 0);
  scaler.reset(sws_getContext(wanted.width, wanted.height, source, wanted.width, wanted.height,
                              is_wide ? AV_PIX_FMT_BGR48LE : AV_PIX_FMT_BGR24, flags, nullptr,
                              nullptr, nullptr));
  if (!scaler) return false;
  // What libswscale takes for granted stays untouched.
  const int matrix = scaler_matrix(wanted.matrix).value_or(SWS_CS_ITU601);
  const bool is_usual =
      matrix == SWS_CS_ITU601 && wanted.is_full_range == is_full_by_format(wanted.format);
  if (!is_usual) {
    sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(matrix),
                             wanted.is_full_range ? 1 : 0, sws_getCoefficients(SWS_CS_DEFAULT), 1,
                             0, 1 << 16, 1 << 16);
  }
  light.reset();
  if (is_wide) light.emplace(wanted.curve, wanted.primaries);
  coding = wanted;
  return true;
}

VideoColour::VideoColour() : impl_(std::make_unique<Impl>()) {}
VideoColour::~VideoColour() = default;
VideoColour::VideoColour(VideoColour&&) noexcept = default;
VideoColour& VideoColour::operator=(VideoColour&&) noexcept = default;

bool VideoColour::convert(const AVFrame& picture, cv::Mat& bgr, std::string& fault) {
  Coding found;
  if (!impl_->read_coding(picture, found, fault)) return false;
  if (!impl_->coding || !(*impl_->coding == found)) {
    if (!impl_->prepare(found)) {
      fault = "has pictures in a pixel format that is not read";
      return false;
    }
    impl_->note_coding(picture, found);
  }
  // libswscale writes whole blocks of pixels, beyond the end of rows that are not padded.
  constexpr int block = 16;
  cv::Mat& target = found.needs_light() ? impl_->wide : impl_->rows;
  target.create(found.height, (found.width + block - 1) / block * block,
                found.needs_light() ? CV_16UC3 : CV_8UC3);
  std::uint8_t* const planes[4] = {target.data, nullptr, nullptr, nullptr};
  const int strides[4] = {static_cast<int>(target.step[0]), 0, 0, 0};
  if (sws_scale(impl_->scaler.get(), picture.data, picture.linesize, 0, found.height, planes,
                strides) != found.height) {
    fault = "has a picture that cannot be converted";
    return false;
  }
  if (!found.needs_light()) {
    target.colRange(0, found.width).copyTo(bgr);
  } else {
    bgr.create(found.height, found.width, CV_8UC3);
    for (int row = 0; row < found.height; ++row) {
      impl_->light->convert(impl_->wide.ptr<std::uint16_t>(row), bgr.ptr<std::uint8_t>(row),
                            found.width);
    }
  }
  return true;
}

const std::vector<std::string>& VideoColour::notes() const {
  return impl_->notes;
}

}  // namespace sheen::capture
