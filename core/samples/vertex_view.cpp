// SPDX-License-Identifier: MIT
#include "core/samples/vertex_view.h"

#include "core/concurrency/parallel_for.h"

#include <cassert>

namespace sheen::core {
namespace {

void resize(VertexView& view, std::size_t count) {
  for (auto* column : {&view.x_px, &view.y_px, &view.depth_m, &view.u, &view.v}) {
    column->resize(count);
  }
  view.rejection.resize(count);
}

/// Where pixels may lie so that they keep their distance to the border.
struct PixelRange {
  double low;
  double high_x;
  double high_y;
  // Written so that a pixel that is not a number is outside.
  [[nodiscard]] bool holds(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= low && pixel.x() <= high_x && pixel.y() >= low && pixel.y() <= high_y;
  }
};

VertexRejection rejection_by_cosine(float cosine, float min_cosine) {
  if (!(cosine > 0.0f)) return VertexRejection::back_facing;
  return cosine < min_cosine ? VertexRejection::grazing : VertexRejection::none;
}

}  // namespace

std::string_view name_of(VertexRejection rejection) {
  constexpr std::array<std::string_view, kVertexRejectionCount> names = {
      "none", "outside_image", "back_facing", "grazing", "occluded"};
  return names[static_cast<std::size_t>(rejection)];
}

std::vector<TangentFrame> tangent_frames(const Mesh& mesh) {
  const Eigen::Vector3f zero = Eigen::Vector3f::Zero();
  std::vector<TangentFrame> frames(mesh.positions.size(), TangentFrame{zero, zero, zero});
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex_idx : triangle) {
      frames[vertex_idx] = tangent_frame(mesh.normals[vertex_idx]);
    }
  }
  return frames;
}

Eigen::Vector3f eye_in_object(const Eigen::Isometry3d& camera_from_object) {
  return (-(camera_from_object.linear().transpose() * camera_from_object.translation()))
      .cast<float>();
}

void project_vertices(const Mesh& mesh, const std::vector<TangentFrame>& frames,
                      const CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                      const SamplingLimits& limits, int threads, VertexView& view) {
  assert(frames.size() == mesh.positions.size());
  assert(limits.border_margin_px >= 1.0f);
  const auto margin = static_cast<double>(limits.border_margin_px);
  const PixelRange range{margin, camera.width_px() - 1 - margin, camera.height_px() - 1 - margin};
  const Eigen::Vector3f eye = eye_in_object(camera_from_object);
  const Eigen::Matrix3d rotation = camera_from_object.linear();
  const Eigen::Vector3d translation = camera_from_object.translation();
  resize(view, mesh.positions.size());

  parallel_for(mesh.positions.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // Project.
      const Eigen::Vector3d in_camera = rotation * mesh.positions[i].cast<double>() + translation;
      const std::optional<Eigen::Vector2d> pixel = camera.project(in_camera);
      if (!pixel || !range.holds(*pixel)) {
        view.rejection[i] = VertexRejection::outside_image;
        continue;
      }
      view.x_px[i] = static_cast<float>(pixel->x());
      view.y_px[i] = static_cast<float>(pixel->y());
      view.depth_m[i] = static_cast<float>(in_camera.z());

      // Turn the view into the patch's own frame.
      const DiscDirection direction = direction_towards(frames[i], mesh.positions[i], eye);
      view.u[i] = direction.uv.x();
      view.v[i] = direction.uv.y();
      view.rejection[i] = rejection_by_cosine(direction.cosine, limits.min_cosine);
    }
  });
}

std::array<std::size_t, kVertexRejectionCount> count_rejections(const VertexView& view) {
  std::array<std::size_t, kVertexRejectionCount> counts{};
  for (const VertexRejection rejection : view.rejection) {
    ++counts[static_cast<std::size_t>(rejection)];
  }
  return counts;
}

}  // namespace sheen::core
