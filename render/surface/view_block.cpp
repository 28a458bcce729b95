// SPDX-License-Identifier: MIT
#include "render/surface/view_block.h"

#include "core/samples/vertex_view.h"
#include "render/shaders/shader_text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sheen::render {
namespace {

std::array<float, 4> floats(double x, double y, double z, double w) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z),
          static_cast<float>(w)};
}

/// Distance from the axis, in the plane z = 1, of what the image's corners see.
double widest_radius(const core::CameraModel& camera) {
  double widest = 0;
  for (const double x : {-0.5, camera.width_px() - 0.5}) {
    for (const double y : {-0.5, camera.height_px() - 0.5}) {
      const auto ray = camera.unproject({x, y});
      if (!ray) return camera.valid_radius();
      widest = std::max(widest, ray->head<2>().norm());
    }
  }
  return widest;
}

/// Largest second derivative of the lens map at a point, over a few directions.
double curvature(const core::CameraModel& camera, const Eigen::Vector2d& p) {
  constexpr double h = 1e-3;
  constexpr double diagonal = 0.7071067811865476;
  double largest = 0;
  for (const Eigen::Vector2d& direction :
       {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(diagonal, diagonal),
        Eigen::Vector2d(diagonal, -diagonal)}) {
    const Eigen::Vector2d second = camera.distort(p + h * direction) - 2 * camera.distort(p) +
                                   camera.distort(p - h * direction);
    largest = std::max(largest, second.norm() / (h * h));
  }
  return largest;
}

}  // namespace

ViewBlock make_view_block(const core::CameraModel& camera,
                          const Eigen::Isometry3d& camera_from_object, double near_m,
                          double longest_segment) {
  const core::CameraModel::Intrinsics& in = camera.intrinsics();
  const Eigen::Vector3d eye = core::eye_in_object(camera_from_object).cast<double>();
  ViewBlock block{};
  Eigen::Map<Eigen::Matrix4f>(block.camera_from_object.data()) =
      camera_from_object.matrix().cast<float>();
  block.pinhole =
      floats(in.focal_px.x(), in.focal_px.y(), in.principal_px.x(), in.principal_px.y());
  std::transform(in.distortion.begin(), in.distortion.end(), block.lens.begin(),
                 [](double k) { return static_cast<float>(k); });
  block.lens_kind = static_cast<std::int32_t>(in.lens);
  block.eye_and_near = floats(eye.x(), eye.y(), eye.z(), near_m);
  block.image =
      floats(in.width_px, in.height_px, camera.valid_radius(), std::min(longest_segment, 1e9));
  return block;
}

double longest_straight_segment(const core::CameraModel& camera) {
  if (!camera.curves_lines()) return std::numeric_limits<double>::infinity();

  // Look for the strongest bend on a grid over the disc of angles that the image sees.
  constexpr int steps = 8;
  const double widest_rad = std::atan(std::min(widest_radius(camera), camera.valid_radius()));
  double strongest = 0;
  for (int i = -steps; i <= steps; ++i) {
    for (int j = -steps; j <= steps; ++j) {
      const Eigen::Vector2d at(i, j);
      if (at.norm() > steps * (1 + 1e-9)) continue;
      const Eigen::Vector2d p = at.stableNormalized() * std::tan(at.norm() / steps * widest_rad);
      strongest = std::max(strongest, curvature(camera, p));
    }
  }
  const double focal_px = camera.intrinsics().focal_px.maxCoeff();
  return std::sqrt(8 * kSagittaLimitPx / (focal_px * std::max(strongest, 1e-12)));
}

std::string lens_glsl() {
  std::string functions =
      "#define Real float\n#define LENS_FUNCTION\n#define LENS_ARRAY(name) float name[8]\n"
      "#define LENS_OUT(name) out float name\n";
  std::string choice =
      "vec2 distort(vec2 ideal) {\n"
      "  float k[8] = float[8](lens[0].x, lens[0].y, lens[0].z, lens[0].w,\n"
      "                        lens[1].x, lens[1].y, lens[1].z, lens[1].w);\n"
      "  vec2 moved = ideal;\n";
  for (const core::LensTraits& traits : core::kLenses) {
    const std::string name(traits.name);
    functions += core::lens_text(name + ".lens");
    choice += "  if (lens_kind == " + std::to_string(static_cast<int>(traits.kind)) + ") distort_" +
              name + "(k, ideal.x, ideal.y, moved.x, moved.y);\n";
  }
  choice += "  return moved;\n}\n";
  return std::string(shader_text("shaders/view_block.glsl")) + functions + choice +
         std::string(shader_text("shaders/clip.glsl"));
}

}  // namespace sheen::render
