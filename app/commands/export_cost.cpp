// SPDX-License-Identifier: MIT
#include "app/commands/export_cost.h"

#include "app/terminal_sink.h"
#include "core/mesh/bounds.h"
#include "evaluation/views/evaluate_views.h"
#include "fitting/patch_light_field.h"
#include "pipeline/light/session_light.h"
#include "pipeline/pose_frames.h"
#include "pipeline/session_readout.h"
#include "render/renderer.h"
#include "render/surface/surface_renderer.h"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sheen::app {
namespace {

constexpr int kSides = 12;
constexpr int kSidePx = 480;

/// Directions spread evenly over the sphere (Fibonacci's lattice).
Eigen::Vector3d side(int i) {
  const double z = 1 - (2 * i + 1.0) / kSides;
  const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
  const double level = std::sqrt(1 - z * z);
  return {level * std::cos(turn), level * std::sin(turn), z};
}

/// A camera that sees the whole mesh from a side.
Eigen::Isometry3d camera_from_object(const core::Mesh& mesh, const Eigen::Vector3d& towards_eye) {
  const Eigen::AlignedBox3f box = core::bounds_of(mesh);
  const Eigen::Vector3d centre = box.center().cast<double>();
  const double radius = 0.5 * static_cast<double>(box.diagonal().norm());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear().row(2) = -towards_eye.transpose();
  pose.linear().row(0) = towards_eye.unitOrthogonal().transpose();
  pose.linear().row(1) = -towards_eye.cross(towards_eye.unitOrthogonal()).transpose();
  pose.translation() = -pose.linear() * (centre + 4 * radius * towards_eye);
  return pose;
}

core::CameraModel side_camera() {
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = intrinsics.height_px = kSidePx;
  intrinsics.focal_px.setConstant(1.8 * kSidePx);
  intrinsics.principal_px.setConstant(0.5 * (kSidePx - 1));
  return core::CameraModel(intrinsics);
}

double difference_db(const core::Mesh& mesh, render::Renderer& model, render::Renderer& converted) {
  double squared = 0;
  double numbers = 0;
  for (int i = 0; i < kSides; ++i) {
    const Eigen::Isometry3d pose = camera_from_object(mesh, side(i));
    const render::RenderedView a = model.render(side_camera(), pose);
    const render::RenderedView b = converted.render(side_camera(), pose);
    cv::Mat both;
    cv::bitwise_and(a.mask, b.mask, both);
    const double norm = cv::norm(a.image, b.image, cv::NORM_L2, both);
    squared += norm * norm;
    numbers += 3.0 * cv::countNonZero(both);
  }
  constexpr double none = 1e-2;  // of one level, where no pixel differs
  return 10 * std::log10(255.0 * 255.0 * std::max(numbers, 1.0) / std::max(squared, none));
}

ConversionCost::OnViews cost_on_views(render::Context& gl, const fitting::Model& model,
                                      const std::array<render::Renderer*, 2>& renderers,
                                      const std::filesystem::path& folder,
                                      const pipeline::FrameChoice& frames,
                                      const CommandContext& context) {
  capture::Session session = capture::open_session(folder);
  TerminalSink sink(context);
  session.take_offset(model.mesh.offset);
  pipeline::complete_readout(session, frames, sink);
  pipeline::complete_light(session, frames, sink);
  const auto views = pipeline::pose_frames(session, frames, sink);
  int done = 0;
  const auto summaries = evaluation::evaluate_views(
      gl, {session, model.mesh, views}, renderers, [&](const evaluation::ComparedView&) {
        sink.progress({"comparing", ++done, static_cast<int>(views.size())});
      });
  return {static_cast<std::size_t>(done), summaries[0].mean.psnr_db, summaries[1].mean.psnr_db};
}

}  // namespace

ConversionCost conversion_cost(const fitting::Model& model, const fitting::Model& converted,
                               const std::filesystem::path& session,
                               const pipeline::FrameChoice& frames, const CommandContext& context) {
  const auto gl = render::make_osmesa_context();
  const auto before = render::make_renderer(*gl, model.mesh, *model.light_field, context.threads);
  // Not by its name: what a reader sees need not be a representation of this program.
  const auto& patches = fitting::require_patches(*converted.light_field, "the comparison");
  const auto after =
      render::make_gl_surface_renderer(*gl, converted.mesh, patches, context.threads);
  ConversionCost cost;
  cost.difference_db = difference_db(model.mesh, *before, *after);
  if (!session.empty()) {
    cost.on_views =
        cost_on_views(*gl, model, {before.get(), after.get()}, session, frames, context);
  }
  return cost;
}

nlohmann::ordered_json to_json(const ConversionCost& cost) {
  nlohmann::ordered_json document{{"difference_db", cost.difference_db}};
  if (cost.on_views) {
    document["on_views"] = {{"views", cost.on_views->views},
                            {"model_db", cost.on_views->model_db},
                            {"converted_db", cost.on_views->converted_db}};
  }
  return document;
}

std::string to_text(const ConversionCost& cost) {
  std::string text =
      fmt::format("pictures {:.1f} dB beside the model's, from all sides\n", cost.difference_db);
  if (cost.on_views) {
    text +=
        fmt::format("on views {:.3f} dB, the model {:.3f} dB: {:.3f} dB lost over {} views\n",
                    cost.on_views->converted_db, cost.on_views->model_db,
                    cost.on_views->model_db - cost.on_views->converted_db, cost.on_views->views);
  }
  return text;
}

}  // namespace sheen::app
