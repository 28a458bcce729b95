// SPDX-License-Identifier: MIT
#include "app/commands/capture_options.h"

#include "capture/calibration/camera_file.h"
#include "capture/session/session.h"
#include "core/diagnostics/error.h"

#include <Eigen/SVD>

#include <charconv>
#include <utility>

namespace sheen::app {
namespace {

std::optional<int> parse_int(std::string_view text) {
  int number = 0;
  const auto [stop, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (status != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return number;
}

void add_camera_options(Command command, CaptureOptions& options) {
  using capture::PixelFormat;
  command
      .option(
          "device", options.camera.device,
          "Camera: a device, or the address of an MJPEG (http://...) or H.264 stream (rtsp://...)")
      .show_default();
  command.flag("--list", options.list, "List cameras, their modes and controls");
  command
      .option(
          "--size",
          [&options](const std::string& text) {
            const std::size_t x = text.find('x');
            const auto width = parse_int(std::string_view(text).substr(0, x));
            const auto height = x == std::string::npos
                                    ? std::nullopt
                                    : parse_int(std::string_view(text).substr(x + 1));
            if (!width || !height) throw UsageError("--size: write it like 1280x720");
            options.camera.mode.size = capture::ImageSize{*width, *height};
          },
          "Image size (default: that of the camera file, else the camera's usual)")
      .type("WxH");
  command.option("--fps", options.camera.mode.fps, "Frame rate (default: the camera's largest)")
      .positive();
  command.choice<std::optional<PixelFormat>>(
      "--format", options.camera.mode.format,
      {{"mjpeg", PixelFormat::mjpeg}, {"yuyv", PixelFormat::yuyv}, {"nv12", PixelFormat::nv12}},
      "How the camera packs images (default: the fastest)");
  command
      .option(
          "--control",
          [&options](const std::vector<std::string>& settings) {
            for (const std::string& setting : settings) {
              const std::size_t equals = setting.find('=');
              const auto value = equals == std::string::npos
                                     ? std::nullopt
                                     : parse_int(std::string_view(setting).substr(equals + 1));
              if (!value) throw UsageError("--control: write it like gain=10");
              options.camera.controls.push_back({setting.substr(0, equals), *value});
            }
          },
          "Set a control of the camera first, as --list names it")
      .type("NAME=VALUE");
  command.flag("!--no-lock", options.camera.lock_automatics,
               "Leave exposure, gain, white balance and focus to the camera");
}

Eigen::Isometry3d transform_of(const std::vector<double>& numbers) {
  Eigen::Matrix4d T;
  for (Eigen::Index i = 0; i < 16; ++i) T(i / 4, i % 4) = numbers[static_cast<std::size_t>(i)];
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  const bool is_rigid = T.allFinite() && R.isUnitary(1e-3) && R.determinant() > 0 &&
                        T.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1));
  if (!is_rigid) {
    throw core::bad_input("--T-stage-object", "is no rotation and translation",
                          "give 16 numbers row by row, the last row 0 0 0 1");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = svd.matrixU() * svd.matrixV().transpose();
  transform.translation() = T.topRightCorner<3, 1>();
  return transform;
}

}  // namespace

void add_capture_options(Command command, CaptureOptions& options) {
  add_camera_options(command, options);
  command
      .option("-o,--output", options.session,
              "Session folder to record; NAME.glb: the model, its session is the folder NAME")
      .type("SESSION");
  command
      .option("--like", options.like,
              "Take camera file, board, mesh and the object's place from this session")
      .type("SESSION");
  command
      .option("--camera", options.camera_file,
              "Camera file, from sheen calibrate (default: found from the walk)")
      .type("FILE");
  command
      .option("--board", options.board,
              "board.yaml: where the tags lie (default: the sheet of sheen board)")
      .type("FILE");
  command.option("--mesh", options.mesh, "The object, in metres (default: measured from the walk)")
      .type("FILE");
  command
      .option("--T-stage-object", options.board_from_object,
              "Where the object stands: 16 numbers row by row (default: as in --like, else the "
              "board's own frame)")
      .numbers(16);
  command.option("--frames", options.frames, "Record so many images (default: until Ctrl-C)")
      .positive();
  command.option("--seconds", options.seconds, "Record so long").positive();
  command.flag("--headless", options.headless, "Without a window");
  command.option("--model", options.fit.output, "Model to write (default: model.glb in SESSION)")
      .type("MODEL.glb");
  add_model_options(command, options.fit);
}

capture::SessionSetup read_setup(const CaptureOptions& options) {
  capture::SessionSetup setup;
  if (!options.like.empty()) {
    const capture::Session like = capture::open_session(options.like);
    setup = {like.camera, like.board.value_or(""), like.mesh, like.board_from_object};
  }
  if (!options.camera_file.empty()) setup.camera = capture::read_camera(options.camera_file);
  if (!options.board.empty()) setup.board = options.board;
  if (!options.mesh.empty()) setup.mesh = options.mesh;
  if (!options.board_from_object.empty()) {
    if (setup.mesh.empty()) {
      throw core::bad_input("--T-stage-object", "places a mesh, and there is none",
                            "give --mesh, or leave it out: a measured mesh lies in the board's "
                            "frame");
    }
    setup.board_from_object = transform_of(options.board_from_object);
  }
  setup.camera_is_guessed = setup.camera.width_px() == 0;
  return setup;
}

}  // namespace sheen::app
