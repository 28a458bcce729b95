// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/layer.h"
#include "core/mesh/mesh.h"
#include "fitting/fitter.h"
#include "fitting/light_field.h"
#include "render/renderer.h"
#include "render/surface/surface_layer.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace sheen::app {

/// Scores of every patch for the two heat maps, [0, 1] or render::kUnseenScore.
struct PatchScores {
  std::vector<float> needs_views;
  std::vector<float> misfit;
};

/// Colours of the two scales, for legends: 0, 1/2, 1 as sRGB.
std::array<std::array<float, 3>, 3> scale_of(Layer layer);
/// Colour of patches that nobody has seen, on both.
std::array<float, 3> unseen_colour();

/// The object in every layer, on the GPU. Changes are sent in pieces, so that no redraw waits long
/// for them. All calls with the context current, on one thread.
class ObjectPainter {
 public:
  /// All outlive it; `gl` is of `context`.
  ObjectPainter(render::Context& context, const render::gl::Functions& gl, const core::Mesh& mesh);

  /// Shows another light field from now on, all of it sent at once. It outlives its use here.
  void show(const fitting::LightField& light_field);
  /// Elements of the light field that have changed since they were sent.
  void note_changes(const fitting::ModelUpdate& update);
  /// Sends some of the changed elements, about `budget_bytes`; the next call goes on where this one
  /// stopped. The light field must not change meanwhile. Returns the bytes sent.
  std::size_t send_changes(std::size_t budget_bytes);
  [[nodiscard]] bool has_changes() const { return changed_count_ > 0; }
  /// Whether drawing the radiance reads the light field, which then must not change meanwhile.
  [[nodiscard]] bool draws_from_model() const {
    return radiance_ != nullptr && radiance_->reads_light_field();
  }

  void set_scores(PatchScores scores);

  /// Of the mesh, object frame.
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }

  /// Grows with everything that makes an earlier drawing out of date.
  [[nodiscard]] std::size_t version() const { return version_; }

  /// Draws one layer as a camera sees it. Before a light field is shown, the mesh stands in for
  /// the radiance.
  void draw(Layer layer, render::gl::OffscreenTarget& target, const core::CameraModel& camera,
            const Eigen::Isometry3d& camera_from_object);

 private:
  render::SurfaceLayer& painted(Layer layer);

  render::Context& context_;
  const render::gl::Functions& gl_;
  const core::Mesh& mesh_;
  Eigen::AlignedBox3d bounds_;
  PatchScores scores_;
  std::unique_ptr<render::Renderer> radiance_;  ///< null before a light field is shown
  std::array<std::unique_ptr<render::SurfaceLayer>, kLayers.size()> layers_;  ///< made at need
  std::vector<std::uint8_t> is_changed_;                                      ///< by element
  std::size_t changed_count_ = 0;
  std::size_t version_ = 0;
  std::size_t cursor_ = 0;  ///< where the next piece begins
  std::vector<std::uint32_t> piece_;
};

}  // namespace sheen::app
