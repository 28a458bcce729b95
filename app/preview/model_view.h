// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/object_painter.h"
#include "app/preview/orbit_camera.h"
#include "app/preview/overlay.h"
#include "app/preview/view_state.h"
#include "core/visibility/ray_caster.h"

#include <Eigen/Geometry>
#include <imgui.h>

#include <optional>
#include <vector>

namespace sheen::app {

/// Cameras to be drawn round the object, all brought nearer by the same factor.
struct CameraTrail {
  const core::CameraModel* lens = nullptr;  ///< null: none
  std::vector<Eigen::Isometry3d> poses;     ///< camera_from_object, in order
  std::optional<Eigen::Isometry3d> present;
  std::optional<Eigen::Vector3d> hint;  ///< where to stand next, object frame
  /// Directions from the object, unit length, from which nobody has looked though somebody should.
  std::vector<Eigen::Vector3d> missing;
};

/// The object seen by a camera that the mouse turns.
class ModelView {
 public:
  /// `gl` and `mesh` outlive it; `up` is the upright axis in the object frame. `with_cameras`
  /// leaves room for them round the object.
  ModelView(const render::gl::Functions& gl, const core::Mesh& mesh, const Eigen::Vector3d& up,
            bool with_cameras);

  /// Draws into the image that `show` puts on the screen; needs the light field to keep still if
  /// the painter says so. What has not changed is drawn once more, finer, and then no more;
  /// `hastily` draws what has changed with a quarter of the pixels.
  void paint(ObjectPainter& painter, Layer layer, bool hastily);
  /// Whether the next `paint` would draw finer.
  [[nodiscard]] bool is_coarse() const { return !is_fine_; }
  /// Fills a rectangle of the present ImGui window (pixels of the window) and takes the mouse in.
  /// A small one shows fewer lines and takes no mouse.
  void show(const ImVec2& corner, const ImVec2& size, const ViewState& state,
            const CameraTrail& trail, bool is_large);

  OrbitCamera& camera() { return camera_; }
  /// Vertex under the cursor at the last `show`.
  [[nodiscard]] std::optional<std::uint32_t> vertex_under_cursor() const { return under_cursor_; }

 private:
  void take_mouse(const ImVec2& corner, const ImVec2& size);
  void draw_cameras(const Overlay& overlay, const CameraTrail& trail, bool with_path) const;
  [[nodiscard]] Eigen::Isometry3d brought_near(const Eigen::Isometry3d& camera_from_object,
                                               double factor) const;
  [[nodiscard]] std::optional<std::uint32_t> vertex_at(const Eigen::Vector2d& pixel) const;

  const core::Mesh& mesh_;
  OrbitCamera camera_;
  core::RayCaster caster_;
  render::gl::OffscreenTarget target_;
  core::CameraModel lens_ = OrbitCamera::lens(640, 360);  ///< of the image to be painted
  core::CameraModel painted_lens_;
  Eigen::Isometry3d painted_from_ = Eigen::Isometry3d::Identity();
  Layer painted_layer_ = Layer::mesh;
  std::size_t painted_version_ = 0;
  Eigen::AlignedBox2f drawn_part_;
  bool is_fine_ = false;
  std::optional<std::uint32_t> under_cursor_;
};

}  // namespace sheen::app
