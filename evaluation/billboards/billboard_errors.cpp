// SPDX-License-Identifier: MIT
#include "evaluation/billboards/billboard_errors.h"

#include "core/samples/vertex_view.h"
#include "fitting/billboard/bake.h"
#include "fitting/billboard/directions.h"
#include "fitting/mean/mean_light_field.h"
#include "render/billboard/draw_frames.h"
#include "render/surface/surface_renderer.h"

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace sheen::evaluation {
namespace {

namespace billboard = fitting::billboard;

constexpr int kBakedDirections = 5120;

double radians(double degrees) {
  return degrees * M_PI / 180;
}

std::vector<Eigen::Vector3f> viewer_directions() {
  std::vector<Eigen::Vector3f> directions;
  for (int meridian = 0; meridian < 6; ++meridian) {
    for (const double latitude : {radians(-30), radians(30)}) {
      const double longitude = radians(60 * meridian);
      directions.emplace_back(Eigen::Vector3d(std::cos(latitude) * std::cos(longitude),
                                              std::cos(latitude) * std::sin(longitude),
                                              std::sin(latitude))
                                  .cast<float>());
    }
  }
  directions.emplace_back(0.0f, 0.0f, 1.0f);
  directions.emplace_back(0.0f, 0.0f, -1.0f);
  return directions;
}

/// Grey, under a large lamp that is fixed to the object: no side is black.
fitting::mean::MeanLightField lit(const core::Mesh& mesh) {
  constexpr float darkest = 0.15f;
  const Eigen::Vector3f lamp = Eigen::Vector3f(1.0f, -2.0f, 2.0f).normalized();
  fitting::mean::MeanLightField light_field(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const float grey = darkest + (1 - darkest) * 0.5f * (1 + mesh.normals[i].dot(lamp));
    light_field.store(i, Eigen::Vector3f::Constant(grey), true);
  }
  return light_field;
}

/// Where the object's centre lies within a pixel; the same series for every object, evenly spread
/// (the fractions of multiples of the plastic number's powers). From afar an object is a few
/// pixels, whose errors depend on it.
Eigen::Vector2d shift_px(std::size_t number) {
  const Eigen::Array2d multiples =
      static_cast<double>(number) * Eigen::Array2d(0.7548776662466927, 0.5698402909980532);
  return (multiples - multiples.floor() - 0.5).matrix();
}

Eigen::Isometry3d looking_at(const Eigen::Vector3f& centre, const Eigen::Vector3f& from,
                             double distance_m) {
  const core::TangentFrame frame = core::tangent_frame(from);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << frame.tangent.cast<double>().transpose(),
      -frame.bitangent.cast<double>().transpose(), -from.cast<double>().transpose();
  pose.translation() = -(pose.linear() * centre.cast<double>());
  pose.translation().z() += distance_m;
  return pose;
}

/// A viewer whose image is cut to what can show the object: much of it is background from afar.
struct Viewer {
  Eigen::Isometry3d camera_from_object;
  double focal_px;
  int side_px;
  Eigen::Vector2d shift_px;  ///< of the object's centre from the image's middle
};

Viewer viewer_at(const billboard::Sphere& sphere, const Eigen::Vector3f& from, double field_deg,
                 double relative_distance, int side_px, const Eigen::Vector2d& shift_px) {
  const double half_angle = radians(field_deg / 2);
  const auto radius_m = static_cast<double>(sphere.radius_m);
  const double distance_m = relative_distance * radius_m / std::sin(half_angle);
  const double focal_px = side_px / 2.0 / std::tan(half_angle);
  Viewer viewer{looking_at(sphere.centre, from, distance_m), focal_px, side_px, shift_px};
  // The sphere's outline, and the circle that a frame of 90 degrees shows on the plane through the
  // centre, sqrt(2) radii around it.
  const double beyond_m2 = distance_m * distance_m - radius_m * radius_m;
  if (beyond_m2 > 0) {
    const double half_px = focal_px * std::sqrt(2 / beyond_m2) * radius_m + 3;
    // As odd or even as the image, so that pixels stay where they are.
    const int cut = std::max(0, static_cast<int>(side_px / 2.0 - half_px));
    viewer.side_px = side_px - 2 * cut;
  }
  return viewer;
}

/// Sum of absolute differences, and the pixels of the box of what either image shows.
struct Difference {
  double total = 0;
  int box_px = 0;
};

Difference difference(const cv::Mat& image, const cv::Mat& exact) {
  cv::Mat shown;
  cv::Mat channels_or;
  cv::max(image, exact, shown);
  cv::transform(shown, channels_or, cv::Matx13f(1, 1, 1));
  return {cv::norm(image, exact, cv::NORM_L1), cv::boundingRect(channels_or != 0).area()};
}

/// Everything that the viewers of one object need.
class Study {
 public:
  Study(const core::Mesh& mesh, const BillboardImages& images, int threads)
      : mesh_(mesh),
        images_(images),
        threads_(threads),
        sphere_(billboard::bounding_sphere(mesh)),
        tangents_(core::tangent_frames(mesh)),
        look_(lit(mesh)),
        exact_(render::make_reference_surface_renderer(mesh, look_, threads)),
        rays_(threads) {}

  /// The nearest frame of 5,120 for a viewer, with a field of view of the camera that bakes it.
  [[nodiscard]] render::PlacedFrame frame(const Eigen::Vector3f& from, double field_deg) const {
    const auto all = billboard::directions(kBakedDirections);
    const auto nearest = std::ranges::max_element(
        all, {}, [&](const Eigen::Vector3f& direction) { return direction.dot(from); });
    const auto camera = billboard::frame_camera(sphere_, *nearest, field_deg, images_.side_px);
    billboard::FrameBaker baker(mesh_, tangents_, look_, images_.samples);
    return {std::make_shared<render::FramePyramid>(baker.bake(camera), images_.side_px), camera, 1};
  }

  [[nodiscard]] Viewer viewer(const Eigen::Vector3f& from, double field_deg,
                              double relative_distance, const Eigen::Vector2d& shift) const {
    return viewer_at(sphere_, from, field_deg, relative_distance, images_.side_px, shift);
  }

  cv::Mat draw_mesh(const Viewer& viewer) {
    return pixels(exact_->render(camera_of(viewer), viewer.camera_from_object).image, viewer);
  }

  cv::Mat draw_frame(const render::PlacedFrame& frame, const Viewer& viewer) {
    const core::CameraModel camera = camera_of(viewer);
    rays_.set_camera(camera);
    const auto drawn = render::draw_frames(std::span(&frame, 1), billboard::Blending::nearest,
                                           camera, viewer.camera_from_object, rays_, threads_);
    // On black, what is multiplied by its coverage is the image.
    cv::Mat image(drawn.colour.size(), CV_32FC3);
    constexpr std::array channels{0, 0, 1, 1, 2, 2};
    cv::mixChannels(&drawn.colour, 1, &image, 1, channels.data(), 3);
    return pixels(image, viewer);
  }

 private:
  [[nodiscard]] core::CameraModel camera_of(const Viewer& viewer) const {
    core::CameraModel::Intrinsics in;
    in.width_px = in.height_px = viewer.side_px * images_.samples;
    in.focal_px.setConstant(viewer.focal_px * images_.samples);
    in.principal_px = (viewer.shift_px.array() + viewer.side_px / 2.0) * images_.samples - 0.5;
    return core::CameraModel(in);
  }

  /// The points of every pixel become one; CV_8UC3, as an image is stored.
  [[nodiscard]] static cv::Mat pixels(const cv::Mat& points, const Viewer& viewer) {
    cv::Mat exact;
    points.convertTo(exact, CV_32FC3);
    cv::Mat image;
    cv::resize(exact, image, {viewer.side_px, viewer.side_px}, 0, 0, cv::INTER_AREA);
    image.convertTo(image, CV_8UC3);
    return image;
  }

  const core::Mesh& mesh_;
  BillboardImages images_;
  int threads_;
  billboard::Sphere sphere_;
  std::vector<core::TangentFrame> tangents_;
  fitting::mean::MeanLightField look_;
  std::unique_ptr<render::Renderer> exact_;
  render::PixelRays rays_;
};

}  // namespace

std::vector<BillboardErrors> billboard_errors(const core::Mesh& mesh, const BillboardImages& images,
                                              const std::vector<double>& view_fields_deg,
                                              const std::vector<double>& bake_fields_deg,
                                              int threads, const Progress& progress) {
  Study study(mesh, images, threads);
  std::vector<BillboardErrors> all;
  for (const double view_field : view_fields_deg) {
    for (const double bake_field : bake_fields_deg) all.push_back({view_field, bake_field, {}, {}});
  }
  const auto viewers = viewer_directions();
  for (std::size_t v = 0; v < viewers.size(); ++v) {
    progress(fmt::format("billboards, {} px, {} points a pixel: viewer {} of {}", images.side_px,
                         images.samples * images.samples, v + 1, viewers.size()));
    std::vector<render::PlacedFrame> frames;
    for (const double bake_field : bake_fields_deg) {
      frames.push_back(study.frame(viewers[v], bake_field));
    }
    for (std::size_t f = 0; f < view_fields_deg.size(); ++f) {
      for (std::size_t d = 0; d < kDistances.size(); ++d) {
        // Small images cost little.
        const std::size_t repeats = kDistances[d] < 4 ? 1 : 4;
        const double count = static_cast<double>(viewers.size() * repeats);
        for (std::size_t r = 0; r < repeats; ++r) {
          const Viewer viewer = study.viewer(viewers[v], view_fields_deg[f], kDistances[d],
                                             shift_px(repeats * v + r));
          const cv::Mat exact = study.draw_mesh(viewer);
          for (std::size_t b = 0; b < frames.size(); ++b) {
            const auto [total, box_px] = difference(study.draw_frame(frames[b], viewer), exact);
            BillboardErrors& errors = all[f * frames.size() + b];
            errors.total[d] += total / count;
            errors.average[d] += total / std::max(box_px, 1) / count;
          }
        }
      }
    }
  }
  return all;
}

double ErrorLaw::best_distance() const {
  if (!(outline > 0)) return std::numeric_limits<double>::infinity();
  return std::sqrt(std::max(parallax, 0.0) / outline);
}

ErrorLaw fit_law(const BillboardErrors& errors) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < kDistances.size(); ++i) {
    const double d = kDistances[i];
    if (d < 1 || d > 32 || !(errors.average[i] > 0)) continue;
    const Eigen::Vector3d row = Eigen::Vector3d(1 / d, 1, d) / errors.average[i];
    A += row * row.transpose();
    g += row;
  }
  const Eigen::Vector3d theta = A.ldlt().solve(g);
  return {theta[0], theta[1], theta[2]};
}

}  // namespace sheen::evaluation
