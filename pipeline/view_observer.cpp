// SPDX-License-Identifier: MIT
#include "pipeline/view_observer.h"

#include "core/samples/back_projection.h"

#include <utility>

namespace sheen::pipeline {

ViewObserver::ViewObserver(const core::Mesh& mesh, std::unique_ptr<core::Visibility> visibility,
                           const core::SamplingLimits& limits, int threads)
    : points_(core::surface_points(mesh)),
      visibility_(std::move(visibility)),
      limits_(limits),
      threads_(threads) {}

const core::VertexView& ViewObserver::see(const core::CameraModel& camera,
                                          const Eigen::Isometry3d& camera_from_object) {
  core::project_vertices(points_, camera, camera_from_object, limits_, threads_, view_);
  visibility_->reject_occluded(camera, camera_from_object, view_);
  return view_;
}

core::SampleBatch& ViewObserver::sample(const cv::Mat& image) {
  core::back_project(image, view_, batch_);
  return batch_;
}

core::Observation ViewObserver::observe(int frame_index, const cv::Mat& image,
                                        const core::CameraModel& camera,
                                        const Eigen::Isometry3d& camera_from_object) {
  see(camera, camera_from_object);
  sample(image);
  return {frame_index, image, camera, camera_from_object, view_, batch_};
}

}  // namespace sheen::pipeline
