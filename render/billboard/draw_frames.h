// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "fitting/billboard/billboards.h"
#include "render/billboard/frame_pyramid.h"
#include "render/views/pixel_rays.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <memory>
#include <span>
#include <vector>

namespace sheen::render {

/// Depths at which a ray is compared with the surface, from the front of the sphere to its back.
/// The directions of frame and ray are near each other, so it moves by few pixels from one to the
/// next.
inline constexpr int kDepthLayers = 16;
/// Steps from a layer to the surface before it; each leaves a small part of what was wrong.
inline constexpr int kStepsToSurface = 3;
/// A ray whose last step was as long as this part of the radius counts half: it passes behind what
/// the frame shows.
inline constexpr float kMissedPart = 0.02f;

/// How much a frame counts in an image.
struct FrameShare {
  std::size_t frame_idx;
  float share;  ///< all shares add up to 1
};

/// The direction nearest to that of the viewer (any length, not zero) among those that `usable`
/// flags; nothing where there is none.
std::vector<FrameShare> nearest_frame(std::span<const Eigen::Vector3f> directions,
                                      std::span<const std::uint8_t> usable,
                                      const Eigen::Vector3f& towards_viewer);

/// The three to six directions around that of the viewer: those at angles p_i below a reach R that
/// follows from how dense all directions lie, or from the nearest one where many are not usable.
/// Shares are proportional to (1 - p_i / R)^2 / p_i: none enters or leaves with a jump, a direction
/// itself has share 1. A fixed number of frames would jump where more are equally near.
std::vector<FrameShare> frames_around(std::span<const Eigen::Vector3f> directions,
                                      std::span<const std::uint8_t> usable,
                                      const Eigen::Vector3f& towards_viewer);

/// Those that are drawn for an eye (object frame), as the options say.
std::vector<FrameShare> frames_towards(const fitting::billboard::Billboards& billboards,
                                       const Eigen::Vector3f& eye);

/// A frame as the viewer of an image sees it.
struct FrameInView {
  Eigen::Vector3f eye;  ///< in the frame, metres
  Eigen::Matrix3f frame_from_viewer;
  float level;  ///< of detail, FramePyramid::read
};
FrameInView frame_in_view(const fitting::billboard::FrameCamera& camera,
                          const core::CameraModel& viewer,
                          const Eigen::Isometry3d& camera_from_object);

/// A frame that is drawn.
struct PlacedFrame {
  std::shared_ptr<const FramePyramid> image;
  fitting::billboard::FrameCamera camera;
  float share;
};

/// What a viewer sees of frames of one object, before anything is put behind it.
struct DrawnFrames {
  cv::Mat colour;   ///< CV_32FC4: B, G, R times coverage (0 to 255), coverage (0 to 1)
  cv::Mat support;  ///< CV_8UC1: 255 where something seen in the fit contributes
};

/// `nearest`: every frame on the plane through the object's centre. `blended`: every frame where
/// the ray of a pixel meets the surface that its depths describe. `rays` are those of `viewer`. The
/// same on any number of threads.
DrawnFrames draw_frames(std::span<const PlacedFrame> frames, fitting::billboard::Blending blending,
                        const core::CameraModel& viewer,
                        const Eigen::Isometry3d& camera_from_object, const PixelRays& rays,
                        int threads);

}  // namespace sheen::render
