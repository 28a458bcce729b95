// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"
#include "fitting/light_field.h"
#include "render/context/context.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace sheen::render {

namespace gl {
class OffscreenTarget;
}

/// An image of the light field as a camera sees it, lens distortion included.
struct RenderedView {
  cv::Mat image;    ///< CV_8UC3 BGR, black where nothing is
  cv::Mat mask;     ///< CV_8UC1: 255 where the object is seen
  cv::Mat support;  ///< CV_8UC1: 255 where something seen in the fit contributes
};

/// Draws one light field.
class Renderer {
 public:
  virtual ~Renderer() = default;

  /// Takes over elements of the light field that changed (LightField::element_count; ascending, no
  /// repeats). Returns the bytes handed to the GPU.
  virtual std::size_t upload(std::span<const std::uint32_t> elements) = 0;

  virtual RenderedView render(const core::CameraModel& camera,
                              const Eigen::Isometry3d& camera_from_object) = 0;

  /// Draws into `target`, made as large as the camera's image, for a window to show: row 0 is the
  /// image's first row; alpha is 0 beside the object, one half where nothing seen in the fit
  /// contributes, else 1. The context that the renderer was made with is current. By default what
  /// `render` gives is sent there.
  virtual void draw(gl::OffscreenTarget& target, const core::CameraModel& camera,
                    const Eigen::Isometry3d& camera_from_object);

  /// Whether drawing reads the light field, which then must not change meanwhile.
  [[nodiscard]] virtual bool reads_light_field() const { return true; }
};

/// The renderer of a light field's representation, everything uploaded: the descriptor's, or one of
/// those built in. `threads` >= 1 is for what is evaluated on the CPU. Context, mesh and light
/// field must outlive it. Throws core::Error (run_failed) when the representation cannot be drawn
/// or is too large for the driver.
std::unique_ptr<Renderer> make_renderer(Context& context, const core::Mesh& mesh,
                                        const fitting::LightField& light_field, int threads = 1);

}  // namespace sheen::render
