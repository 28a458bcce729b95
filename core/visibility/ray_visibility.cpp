// SPDX-License-Identifier: MIT
#include "core/visibility/ray_visibility.h"

#include "core/concurrency/parallel_for.h"
#include "core/visibility/ray_caster.h"

namespace sheen::core {
namespace {

class RayVisibility : public Visibility {
 public:
  RayVisibility(const Mesh& mesh, int threads) : caster_(mesh), threads_(threads) {}

  void reject_occluded(const CameraModel& /*camera*/, const Eigen::Isometry3d& camera_from_object,
                       VertexView& view) override {
    const Eigen::Vector3f eye = eye_in_object(camera_from_object);
    parallel_for(view.rejection.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (view.rejection[i] != VertexRejection::none) continue;
        if (caster_.vertex_hidden(static_cast<std::uint32_t>(i), eye)) {
          view.rejection[i] = VertexRejection::occluded;
        }
      }
    });
  }

 private:
  RayCaster caster_;
  int threads_;
};

}  // namespace

std::unique_ptr<Visibility> make_ray_visibility(const Mesh& mesh, int threads) {
  return std::make_unique<RayVisibility>(mesh, threads);
}

}  // namespace sheen::core
