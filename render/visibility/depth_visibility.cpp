// SPDX-License-Identifier: MIT
#include "render/visibility/depth_visibility.h"

#include "render/gl/offscreen_target.h"
#include "render/surface/surface_pass.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sheen::render {
namespace {

/// How far the mesh may rise in front of one of its own vertices, in steps of one pixel along the
/// surface. The farthest of four texels on a plane is never nearer than a point between them; the
/// rest is for creases and for surfaces that curve towards the camera. Measured on a bunny at
/// 1280x720, of all candidates: 0.1 step hides 0.08 % wrongly and shows 0.53 % wrongly, 0.25 step
/// 0.05 % and 0.54 %, 0.5 step 0.02 % and 0.55 %.
constexpr float kBiasSteps = 0.25f;
constexpr float kRelativeBias = 1e-5f;  // rounding of depth values
constexpr float kSteepest = 5.0f;       // tangent of the angle between normal and view, at most

class DepthVisibility final : public core::Visibility {
 public:
  DepthVisibility(Context& context, const core::Mesh& mesh)
      : context_(context),
        mesh_(mesh),
        gl_(gl::load_functions(context)),
        pass_(gl_, mesh),
        target_(gl_, gl::Colour::none) {}

  ~DepthVisibility() override { context_.make_current(); }
  DepthVisibility(const DepthVisibility&) = delete;
  DepthVisibility& operator=(const DepthVisibility&) = delete;
  DepthVisibility(DepthVisibility&&) = delete;
  DepthVisibility& operator=(DepthVisibility&&) = delete;

  void reject_occluded(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                       core::VertexView& view) override {
    draw_depth(camera, camera_from_object);
    const Eigen::Vector3f eye = core::eye_in_object(camera_from_object);
    const float pixel_angle = 1.0f / static_cast<float>(camera.intrinsics().focal_px.minCoeff());
    for (std::size_t i = 0; i < view.rejection.size(); ++i) {
      if (view.rejection[i] != core::VertexRejection::none) continue;
      const float bias =
          view.depth_m[i] * (kRelativeBias + kBiasSteps * pixel_angle * slope(i, eye));
      const float nearest = view.depth_m[i] - bias;
      // Depth values are near / depth: the smallest of them is the farthest.
      if (nearest * farthest_around(view.x_px[i], view.y_px[i]) > pass_.near_m()) {
        view.rejection[i] = core::VertexRejection::occluded;
      }
    }
  }

 private:
  void draw_depth(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object) {
    context_.make_current();
    width_px_ = camera.width_px();
    height_px_ = camera.height_px();
    pass_.draw(target_.framebuffer(width_px_, height_px_), camera, camera_from_object);
    depth_.resize(static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_));
    gl_.ReadPixels(0, 0, width_px_, height_px_, GL_DEPTH_COMPONENT, GL_FLOAT, depth_.data());
  }

  /// Change of depth per step across the view, relative to depth: the tangent of the angle between
  /// normal and view direction.
  [[nodiscard]] float slope(std::size_t vertex_idx, const Eigen::Vector3f& eye) const {
    const float cosine =
        mesh_.normals[vertex_idx].dot((eye - mesh_.positions[vertex_idx]).normalized());
    const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
    return sine < kSteepest * cosine ? sine / cosine : kSteepest;
  }

  /// Depth value of the farthest of the four texels around a pixel position.
  [[nodiscard]] float farthest_around(float x_px, float y_px) const {
    const int left = std::clamp(static_cast<int>(std::floor(x_px)), 0, width_px_ - 1);
    const int top = std::clamp(static_cast<int>(std::floor(y_px)), 0, height_px_ - 1);
    const int right = std::min(left + 1, width_px_ - 1);
    const int bottom = std::min(top + 1, height_px_ - 1);
    return std::min(std::min(texel(left, top), texel(right, top)),
                    std::min(texel(left, bottom), texel(right, bottom)));
  }

  [[nodiscard]] float texel(int x, int y) const {
    return depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px_) +
                  static_cast<std::size_t>(x)];
  }

  Context& context_;
  const core::Mesh& mesh_;
  gl::Functions gl_;
  SurfacePass pass_;
  gl::OffscreenTarget target_;
  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<float> depth_;
};

}  // namespace

std::unique_ptr<core::Visibility> make_depth_visibility(Context& context, const core::Mesh& mesh) {
  return std::make_unique<DepthVisibility>(context, mesh);
}

}  // namespace sheen::render
