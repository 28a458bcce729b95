// SPDX-License-Identifier: MIT
#include "pipeline/session_dataset.h"

#include "capture/session/plain_pictures.h"
#include "capture/session/session_file.h"
#include "core/image/undistortion.h"
#include "core/image/write_image.h"
#include "core/mesh/coloured_ply.h"
#include "core/text/lower_case.h"
#include "pipeline/hold_out.h"
#include "pipeline/object_mask.h"
#include "pipeline/posed_views.h"
#include "pipeline/reconstruct.h"
#include "pipeline/session_readout.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace sheen::pipeline {
namespace {

namespace fs = std::filesystem;

/// The fit that needs least: it tells which frames pass and the colours of the surface.
Reconstruction fit_mean_colours(capture::Session session, const DatasetOptions& options,
                                ProgressSink& sink) {
  complete_readout(session, options.frames, sink);
  ReconstructionOptions fit;
  fit.representation = "mean";
  fit.frames = options.frames;
  fit.threads = options.threads;
  return reconstruct({.session = session}, fit, sink);
}

core::Mesh on_board(const core::Mesh& mesh, const Eigen::Isometry3d& board_from_object) {
  core::Mesh placed = mesh;
  placed.offset.setZero();  // taken into board_from_object by the session
  for (Eigen::Vector3f& position : placed.positions) {
    position = (board_from_object * position.cast<double>()).cast<float>();
  }
  for (Eigen::Vector3f& normal : placed.normals) {
    normal = (board_from_object.linear() * normal.cast<double>()).cast<float>();
  }
  return placed;
}

std::vector<capture::DatasetPoint> points_of(const core::Mesh& surface,
                                             const std::vector<Eigen::Vector3f>& colours) {
  std::vector<capture::DatasetPoint> points;
  points.reserve(surface.positions.size());
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Eigen::Array3f bytes = (255.0f * colours[i].array()).round().max(0.0f).min(255.0f);
    points.push_back({surface.positions[i].cast<double>(), bytes.cast<int>()});
  }
  return points;
}

/// Variance of the image's Laplacian, as instant-ngp's script measures it.
double sharpness_of(const cv::Mat& image) {
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  cv::Mat edges;
  cv::Laplacian(grey, edges, CV_64F);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(edges, mean, deviation);
  return deviation[0] * deviation[0];
}

/// Files that can be copied as they are, one per frame; none where images must be made, as all are
/// of a rolling shutter.
std::vector<fs::path> files_to_copy(const capture::Session& session,
                                    const std::vector<PosedFrame>& frames) {
  if (session.camera.intrinsics().readout_s != 0) return {};
  std::vector<int> indices;
  for (const PosedFrame& frame : frames) indices.push_back(frame.index);
  return capture::plain_pictures(session, indices);
}

}  // namespace

capture::Dataset write_session_dataset(const capture::Session& given, const DatasetOptions& options,
                                       const fs::path& folder, ProgressSink& sink) {
  // Learn poses and colours.
  const Reconstruction reconstruction = fit_mean_colours(given, options, sink);
  const capture::Session& session = reconstruction.session();
  const core::Mesh& mesh = reconstruction.object_mesh();
  const std::vector<PosedFrame>& posed = reconstruction.frames().posed;

  // The surface.
  capture::Dataset dataset;
  const core::Mesh surface = on_board(mesh, session.board_from_object);
  const auto colours = reconstruction.light_field().vertex_colours(mesh);
  dataset.surface = "object.ply";
  core::write_coloured_ply(folder / dataset.surface, surface, colours);
  dataset.points = points_of(surface, colours);

  // The images.
  std::optional<core::Undistortion> undistortion;
  if (options.undistort) undistortion.emplace(session.camera);
  dataset.cameras = {undistortion ? undistortion->camera() : session.camera};
  const std::vector<fs::path> files =
      undistortion ? std::vector<fs::path>{} : files_to_copy(session, posed);
  const ObjectMask masks(mesh, options.threads);
  const HoldOut hold_out{options.frames.hold_out};
  fs::create_directories(folder / "images");
  for_each_view(
      session, &mesh, posed,
      [&](const capture::Frame& view, const Eigen::Isometry3d& camera_from_object) {
        const std::size_t i = dataset.frames.size();
        const std::string ending =
            files.empty() ? ".png" : core::lower_case(files[i].extension().string());
        const std::string name = fmt::format("{:06d}{}", view.index, ending);
        const cv::Mat image = undistortion ? undistortion->image(view.image) : view.image;
        cv::Mat mask = masks.draw(dataset.cameras.front(), camera_from_object);
        if (undistortion) mask &= undistortion->covered();
        files.empty() ? core::write_image(folder / "images" / name, image)
                      : capture::copy_into_session(files[i], folder / "images" / name);
        core::write_image(folder / "masks" / (name + ".png"), mask);
        dataset.frames.push_back({.image = "images/" + name,
                                  .world_from_camera = posed[i].camera_from_board.inverse(),
                                  .sharpness = sharpness_of(image),
                                  .mask = "masks/" + name + ".png",
                                  .is_held_out = hold_out.contains(view.index)});
        sink.progress({"writing", static_cast<int>(i) + 1, static_cast<int>(posed.size())});
      });
  return dataset;
}

}  // namespace sheen::pipeline
