// SPDX-License-Identifier: MIT
#include "render/billboard/bake_drawn.h"

#include "fitting/billboard/bake.h"

#include <cstddef>
#include <utility>

namespace sheen::render {
namespace {

using fitting::WeightedColour;
using fitting::billboard::Billboards;
using fitting::billboard::FrameBaker;
using fitting::billboard::FrameCamera;
using fitting::billboard::SurfacePoint;

/// From where orthographic frames are drawn: x z / b is at most half a radius over this.
constexpr double kFarAway_radii = 500;

/// A renderer's camera in the place of a frame's.
struct Stand {
  core::CameraModel camera;
  Eigen::Isometry3d camera_from_object;
};

Stand stand_of(const FrameCamera& frame, int side_px) {
  const double half_px = side_px / 2.0;
  const double distance_m = frame.inverse_distance > 0
                                ? 1 / static_cast<double>(frame.inverse_distance)
                                : kFarAway_radii * static_cast<double>(frame.radius_m);
  core::CameraModel::Intrinsics in;
  in.width_px = in.height_px = side_px;
  in.focal_px.setConstant(half_px / static_cast<double>(frame.half_m) * distance_m);
  in.principal_px.setConstant(half_px - 0.5);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Matrix3d axes = frame.axes.cast<double>();
  pose.linear() << axes.row(0), -axes.row(1), -axes.row(2);
  pose.translation() = -(pose.linear() * frame.centre.cast<double>());
  pose.translation().z() += distance_m;
  return {core::CameraModel(in), pose};
}

class DrawnColours final : public fitting::billboard::FrameColours {
 public:
  DrawnColours(const core::Mesh& mesh, std::vector<Eigen::Vector3f> vertex_colours,
               Renderer& renderer)
      : mesh_(mesh), vertex_colours_(std::move(vertex_colours)), renderer_(renderer) {}

  void look_from(const FrameCamera& frame, std::span<const std::uint8_t> /*needed*/) override {
    const Stand stand = stand_of(frame, frame.side_px * fitting::billboard::kFrameSamples);
    view_ = renderer_.render(stand.camera, stand.camera_from_object);
  }

  [[nodiscard]] WeightedColour at(const SurfacePoint& point,
                                  const cv::Point& fine_pixel) const override {
    if (view_.mask.at<std::uint8_t>(fine_pixel) == 0) return between_vertices(point);
    const auto& bgr = view_.image.at<cv::Vec3b>(fine_pixel);
    const Eigen::Vector3f rgb = Eigen::Vector3f(bgr[2], bgr[1], bgr[0]) / 255.0f;
    const bool is_supported = view_.support.at<std::uint8_t>(fine_pixel) != 0;
    const float weight = is_supported ? 1.0f : fitting::kUnseenWeight;
    return {weight * rgb, weight};
  }

 private:
  [[nodiscard]] WeightedColour between_vertices(const SurfacePoint& point) const {
    const auto& vertex = mesh_.triangles[point.triangle_idx];
    const Eigen::Vector3f rgb =
        (1.0f - point.weight_1 - point.weight_2) * vertex_colours_[vertex[0]] +
        point.weight_1 * vertex_colours_[vertex[1]] + point.weight_2 * vertex_colours_[vertex[2]];
    return {fitting::kUnseenWeight * rgb, fitting::kUnseenWeight};
  }

  const core::Mesh& mesh_;
  std::vector<Eigen::Vector3f> vertex_colours_;
  Renderer& renderer_;
  RenderedView view_;
};

}  // namespace

void bake_drawn(const core::Mesh& mesh, const fitting::LightField& light_field, Renderer& renderer,
                Billboards& billboards) {
  std::vector<Eigen::Vector3f> colours = light_field.vertex_colours(mesh);
  fitting::mean::MeanLightField means(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i) means.store(i, colours[i], true);
  billboards.set_means(means);
  FrameBaker baker(mesh, std::make_unique<DrawnColours>(mesh, std::move(colours), renderer),
                   fitting::billboard::kFrameSamples);
  for (std::size_t i = 0; i < billboards.element_count(); ++i) {
    billboards.set_frame(i, fitting::billboard::encode(baker.bake(billboards.camera(i)),
                                                       billboards.options().views.quality));
  }
}

}  // namespace sheen::render
