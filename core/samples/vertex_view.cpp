// SPDX-License-Identifier: MIT
#include "core/samples/vertex_view.h"

#include "core/concurrency/parallel_for.h"
#include "core/samples/sampling_kernels.h"

#include <algorithm>
#include <cassert>

namespace sheen::core {
namespace {

void resize(VertexView& view, std::size_t count) {
  for (auto* column : {&view.x_px, &view.y_px, &view.depth_m, &view.u, &view.v}) {
    column->resize(count);
  }
  view.rejection.resize(count);
}

ProjectionSetup projection_setup(const CameraModel& camera,
                                 const Eigen::Isometry3d& camera_from_object,
                                 const SamplingLimits& limits) {
  const CameraModel::Intrinsics& lens = camera.intrinsics();
  const Eigen::Vector3f eye = eye_in_object(camera_from_object);
  ProjectionSetup setup{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      setup.rotation[3 * row + column] =
          static_cast<float>(camera_from_object.linear()(row, column));
    }
    setup.translation[row] = static_cast<float>(camera_from_object.translation()[row]);
    setup.eye[row] = eye[row];
  }
  for (int i = 0; i < 2; ++i) {
    setup.focal_px[i] = static_cast<float>(lens.focal_px[i]);
    setup.principal_px[i] = static_cast<float>(lens.principal_px[i]);
  }
  setup.lens = lens.lens;
  std::transform(lens.distortion.begin(), lens.distortion.end(), setup.distortion,
                 [](double k) { return static_cast<float>(k); });
  setup.valid_radius2 = static_cast<float>(camera.valid_radius() * camera.valid_radius());
  setup.low_px = limits.border_margin_px;
  setup.high_px[0] = static_cast<float>(camera.width_px() - 1) - limits.border_margin_px;
  setup.high_px[1] = static_cast<float>(camera.height_px() - 1) - limits.border_margin_px;
  setup.min_cosine = limits.min_cosine;
  return setup;
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

void project_vertices(const SurfacePoints& points, const CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_object, const SamplingLimits& limits,
                      int threads, VertexView& view) {
  assert(limits.border_margin_px >= 1.0f);
  resize(view, points.size());
  const ProjectionSetup setup = projection_setup(camera, camera_from_object, limits);
  const ProjectionColumns columns{points.x.data(),  points.y.data(),  points.z.data(),
                                  points.nx.data(), points.ny.data(), points.nz.data(),
                                  view.x_px.data(), view.y_px.data(), view.depth_m.data(),
                                  view.u.data(),    view.v.data(),    view.rejection.data()};
  const SamplingKernels& kernels = sampling_kernel_sets().front();
  parallel_for(points.size(), threads, [&](std::size_t begin, std::size_t end) {
    kernels.project(setup, columns, begin, end);
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
