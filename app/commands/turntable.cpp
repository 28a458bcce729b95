// SPDX-License-Identifier: MIT
#include "app/commands/turntable.h"

#include "app/commands/smooth_picture.h"
#include "app/preview/orbit_camera.h"
#include "app/terminal_sink.h"
#include "capture/files/video_writer.h"
#include "core/image/write_image.h"
#include "core/text/lower_case.h"
#include "core/text/number.h"
#include "exporters/upright.h"
#include "fitting/model_file/model_file.h"
#include "render/billboard/billboard_renderer.h"
#include "render/multi_eigenspace/copies_renderer.h"
#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace sheen::app {
namespace {

using fitting::billboard::Billboards;
using fitting::multi_eigenspace::MultiEigenspace;

constexpr int kLeastSide_px = 16, kMostSide_px = 8192;
constexpr double kGap = 2.2;  // between the middles of copies, in radii
const cv::Scalar kDark(0x22, 0x1e, 0x1c);
const cv::Scalar kLight(0xf4, 0xf3, 0xf2);

cv::Mat over(const cv::Mat& picture, const cv::Scalar& background) {
  cv::Mat result(picture.size(), CV_8UC3);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const auto& pixel = picture.at<cv::Vec4b>(y, x);
      for (int channel = 0; channel < 3; ++channel) {
        const double mixed =
            (pixel[channel] * pixel[3] + background[channel] * (255 - pixel[3])) / 255;
        result.at<cv::Vec3b>(y, x)[channel] = cv::saturate_cast<std::uint8_t>(mixed);
      }
    }
  }
  return result;
}

int copies_in_row(int count) {
  return static_cast<int>(std::ceil(std::sqrt(count)));
}

/// A square of copies about the object's place, every one turned by the golden angle more.
std::vector<Eigen::Isometry3d> places_of_copies(const Eigen::Vector3d& centre, double radius_m,
                                                int count, const Eigen::Vector3d& up) {
  const int row = copies_in_row(count);
  const Eigen::Vector3d right = up.unitOrthogonal();
  const Eigen::Vector3d forward = up.cross(right);
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Eigen::Isometry3d> places;
  for (int i = 0; i < count; ++i) {
    const double middle = 0.5 * (row - 1);
    const Eigen::Vector3d place =
        kGap * radius_m * ((i % row - middle) * right + (i / row - middle) * forward);
    places.emplace_back(Eigen::Translation3d(centre + place) * Eigen::AngleAxisd(golden * i, up) *
                        Eigen::Translation3d(-centre));
  }
  return places;
}

std::unique_ptr<render::Renderer> renderer_of_copies(render::Context& gl,
                                                     const fitting::LightField& light_field,
                                                     int count, const Eigen::Vector3d& up,
                                                     int threads) {
  if (const auto* const spaces = dynamic_cast<const MultiEigenspace*>(&light_field)) {
    const auto& frame = spaces->frame();
    return render::make_copies_renderer(gl, *spaces,
                                        places_of_copies(frame.centre, frame.radius_m, count, up));
  }
  if (const auto* const billboards = dynamic_cast<const Billboards*>(&light_field)) {
    const auto& [centre, radius_m] = billboards->sphere();
    return render::make_gl_billboard_renderer(
        gl, *billboards,
        places_of_copies(centre.cast<double>(), static_cast<double>(radius_m), count, up), threads);
  }
  throw UsageError("--copies is for models of multi-eigenspace or billboard, this one is of " +
                   std::string(light_field.representation()));
}

bool is_video(const std::filesystem::path& path) {
  return core::lower_case(path.extension().string()) == ".mp4";
}

}  // namespace

cv::Size picture_size(const std::string& text) {
  const auto side = [](const std::string& word) {
    const long long number = core::parse_whole_number(word).value_or(0);
    return number >= kLeastSide_px && number <= kMostSide_px ? static_cast<int>(number) : 0;
  };
  const std::size_t times = std::min(text.find('x'), text.size());
  const cv::Size size(side(text.substr(0, times)),
                      side(text.substr(std::min(times + 1, text.size()))));
  if (size.empty()) {
    throw UsageError("--size is '" + text + "', allowed: WIDTHxHEIGHT, each 16 to 8192");
  }
  return size;
}

std::optional<cv::Scalar> background_colour(const std::string& text) {
  if (text == "none") return std::nullopt;
  if (text == "dark") return kDark;
  if (text == "light") return kLight;
  unsigned value = 0;
  const char* const end = text.data() + text.size();
  const bool is_colour = text.size() == 7 && text.front() == '#' &&
                         std::from_chars(text.data() + 1, end, value, 16).ptr == end;
  if (!is_colour) {
    throw UsageError("--background is '" + text +
                     "', allowed: none, dark, light or a colour such as #204060");
  }
  return cv::Scalar(value & 255u, value >> 8 & 255u, value >> 16);
}

void render_turntable(const std::filesystem::path& path, const std::filesystem::path& output,
                      const TurntableOptions& options, const CommandContext& context) {
  const bool to_video = is_video(output);
  if (to_video && (options.size_px.width % 2 != 0 || options.size_px.height % 2 != 0)) {
    throw UsageError("--size of a video must be even in both directions");
  }
  context.check_outputs({to_video ? output : std::filesystem::path()});
  const fitting::Model model = fitting::read_model(path);
  const auto gl = render::make_osmesa_context();
  const Eigen::Vector3d up = exporters::y_up_from_object(options.up).row(1).cast<double>();
  const bool one = options.copies == 1;
  const auto renderer =
      one ? render::make_renderer(*gl, model.mesh, *model.light_field, context.threads)
          : renderer_of_copies(*gl, *model.light_field, options.copies, up, context.threads);
  // In radii, to the farthest corner of the square.
  const double room = 1 + kGap * (copies_in_row(options.copies) - 1) / std::numbers::sqrt2;
  OrbitCamera camera(model.mesh, up, room);
  std::optional<capture::VideoWriter> video;
  if (to_video) video.emplace(output, options.size_px, options.fps);

  TerminalSink sink(context);
  for (int i = 0; i < options.pictures; ++i) {
    const cv::Mat picture = smooth_picture(*renderer, camera, options.size_px);
    if (video) {
      video->add(over(picture, options.background.value_or(kDark)));
    } else {
      core::write_image(output / fmt::format("{:04d}.png", i),
                        options.background ? over(picture, *options.background) : picture);
    }
    camera.orbit({2.0 / options.pictures, 0}, 1);  // an image's height is half a turn
    sink.progress({"rendering", i + 1, options.pictures});
  }
  if (video) video->finish();
  context.publish({{"pictures", options.pictures}, {"output", output.string()}},
                  fmt::format("written  {} pictures to {}\n", options.pictures, output.string()));
}

}  // namespace sheen::app
