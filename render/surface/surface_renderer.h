// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"
#include "fitting/fitter.h"
#include "fitting/light_field.h"
#include "render/context/context.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <memory>

namespace sheen::render {

/// An image of the light field as a camera sees it, lens distortion included.
struct RenderedView {
  cv::Mat image;    ///< CV_8UC3 BGR, black where nothing is
  cv::Mat mask;     ///< CV_8UC1: 255 where the mesh is seen
  cv::Mat support;  ///< CV_8UC1: 255 where a patch seen in the fit contributes
};

/// Draws one light field on its mesh. Light fields are drawn through the registry of patch shaders
/// (render/surface/patch_shader.h), one per representation; those without one are evaluated on the
/// CPU for every view.
class SurfaceRenderer {
 public:
  virtual ~SurfaceRenderer() = default;

  /// Uploads what changed; `light_field` is the one the renderer was made with.
  virtual void upload(const fitting::ModelUpdate& update) = 0;

  virtual RenderedView render(const core::CameraModel& camera,
                              const Eigen::Isometry3d& camera_from_object) = 0;
};

/// OpenGL: centres evaluated in the vertex stage, colour sum and weight sum interpolated apart and
/// divided per fragment (eq. 7). The lens is exact at vertices; where it would bend an edge by more
/// than 0.05 pixels triangles are tessellated, into at most 64 segments per edge. Pixels no ray of
/// the lens model reaches stay black. May be called from any thread, one at a time; the context is
/// made current there. Context, mesh and light field must outlive the renderer. Throws core::Error
/// (run_failed) for models or images too large for the driver.
std::unique_ptr<SurfaceRenderer> make_gl_surface_renderer(Context& context, const core::Mesh& mesh,
                                                          const fitting::LightField& light_field);

/// Reference without OpenGL: one ray per pixel, same interpolation. Exact at every pixel under any
/// lens distortion; slow.
std::unique_ptr<SurfaceRenderer> make_reference_surface_renderer(
    const core::Mesh& mesh, const fitting::LightField& light_field, int threads);

}  // namespace sheen::render
