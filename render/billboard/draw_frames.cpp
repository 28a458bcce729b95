// SPDX-License-Identifier: MIT
#include "render/billboard/draw_frames.h"

#include "core/concurrency/parallel_for.h"
#include "core/samples/vertex_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sheen::render {
namespace {

using fitting::billboard::Billboards;
using fitting::billboard::Blending;
using fitting::billboard::FrameCamera;
using fitting::billboard::towards_m;

/// Fewer rows of an image are not worth a thread.
constexpr std::size_t kRowsPerThread = 16;
/// Nearer angles count alike, radians.
constexpr float kLeastAngle = 1e-3f;
/// Frames nearer than so many sides of the hexagons that directions form are blended.
constexpr float kReach = 1.3f;

/// A frame as the viewer of an image sees it.
struct ViewedFrame {
  const PlacedFrame& placed;
  FrameInView view;
};

/// Where a ray is seen in a frame.
struct Meeting {
  Eigen::Vector2f place_px;
  float share = 0;  ///< 0: nowhere
};

/// Where the ray meets the plane at distance `z` from that through the centre.
Meeting meet(const ViewedFrame& frame, const Eigen::Vector3f& ray, float z) {
  const float along = (z - frame.view.eye.z()) / ray.z();
  // Written so that a ray that is none meets nothing.
  if (!(along > 0.0f && along < std::numeric_limits<float>::infinity())) return {};
  return {frame.placed.camera.pixel(frame.view.eye + along * ray), frame.placed.share};
}

/// The ray between two depths, the nearer one above the surface, the other one not.
Meeting meet_between(const ViewedFrame& frame, const Eigen::Vector3f& ray, float nearer,
                     float farther) {
  const FrameCamera& camera = frame.placed.camera;
  Meeting meeting;
  float z = farther;
  float step = 0;
  for (int i = 0; i < kStepsToSurface; ++i) {
    meeting = meet(frame, ray, z);
    const float there =
        towards_m(frame.placed.image->depth_code(meeting.place_px), camera.radius_m);
    step = there - z;
    z = std::clamp(there, farther, nearer);
  }
  const float missed = step / (kMissedPart * camera.radius_m);
  meeting.share /= 1.0f + missed * missed;
  return meeting;
}

/// Where it meets what the frame's depths describe first; where it only passes behind that, with a
/// small share.
Meeting meet_surface(const ViewedFrame& frame, const Eigen::Vector3f& ray) {
  const float radius_m = frame.placed.camera.radius_m;
  // Beside the object the frame shows nothing, and that counts.
  Meeting best{Eigen::Vector2f::Constant(-std::numeric_limits<float>::infinity()), 0.0f};
  float nearer = radius_m;
  bool above = true;
  bool beside = true;
  for (int i = 1; i <= kDepthLayers; ++i) {
    const float z = radius_m * (1.0f - 2.0f * static_cast<float>(i) / kDepthLayers);
    const Meeting meeting = meet(frame, ray, z);
    if (meeting.share == 0.0f) return {};
    const auto code = frame.placed.image->surface_code(meeting.place_px);
    const bool below = code && towards_m(static_cast<float>(*code), radius_m) >= z;
    if (below && above) {
      const Meeting crossing = meet_between(frame, ray, nearer, z);
      if (crossing.share > best.share) best = crossing;
      if (2.0f * crossing.share >= frame.placed.share) return crossing;
      beside = false;
    }
    above = !below;
    nearer = z;
  }
  if (beside) best.share = frame.placed.share;
  return best;
}

}  // namespace

std::vector<FrameShare> nearest_frame(std::span<const Eigen::Vector3f> directions,
                                      std::span<const std::uint8_t> usable,
                                      const Eigen::Vector3f& towards_viewer) {
  std::vector<FrameShare> nearest;
  float greatest = -std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const float cosine = directions[i].dot(towards_viewer);
    if (usable[i] == 0 || cosine <= greatest) continue;
    greatest = cosine;
    nearest = {{i, 1.0f}};
  }
  return nearest;
}

std::vector<FrameShare> frames_around(std::span<const Eigen::Vector3f> directions,
                                      std::span<const std::uint8_t> usable,
                                      const Eigen::Vector3f& towards_viewer) {
  const auto nearest = nearest_frame(directions, usable, towards_viewer);
  if (nearest.empty()) return {};
  const Eigen::Vector3f towards = towards_viewer.normalized();
  // The chord, which is the angle where that is small.
  const auto angle_of = [&](std::size_t i) {
    return std::max((directions[i] - towards).norm(), kLeastAngle);
  };
  // Directions are the corners of hexagons with sides h, two for each area of 2.6 h^2; the middle
  // of one has six at the distance h.
  const float side =
      std::sqrt(4 * static_cast<float>(M_PI) / (1.3f * static_cast<float>(directions.size())));
  const float reach = kReach * std::max(side, angle_of(nearest.front().frame_idx));
  std::vector<FrameShare> around;
  float sum = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const float angle = angle_of(i);
    if (usable[i] == 0 || !(angle < reach)) continue;
    const float fade = 1.0f - angle / reach;
    around.push_back({i, fade * fade / angle});
    sum += around.back().share;
  }
  for (FrameShare& one : around) one.share /= sum;
  return around;
}

std::vector<FrameShare> frames_towards(const Billboards& billboards, const Eigen::Vector3f& eye) {
  std::vector<std::uint8_t> usable(billboards.element_count());
  for (std::size_t i = 0; i < usable.size(); ++i) {
    usable[i] = billboards.frame(i).crop.empty() ? 0 : 1;
  }
  const Eigen::Vector3f towards = eye - billboards.sphere().centre;
  return billboards.options().blending == Blending::nearest
             ? nearest_frame(billboards.directions(), usable, towards)
             : frames_around(billboards.directions(), usable, towards);
}

FrameInView frame_in_view(const FrameCamera& camera, const core::CameraModel& viewer,
                          const Eigen::Isometry3d& camera_from_object) {
  const Eigen::Vector3f eye = camera.in_frame(core::eye_in_object(camera_from_object));
  const auto focal_px = static_cast<float>(viewer.intrinsics().focal_px.minCoeff());
  const float view_pixel_m = eye.norm() / focal_px;
  const float frame_pixel_m = 2 * camera.half_m / static_cast<float>(camera.side_px);
  return {eye, camera.axes * camera_from_object.linear().transpose().cast<float>(),
          std::log2(std::max(view_pixel_m / frame_pixel_m, 1.0f))};
}

DrawnFrames draw_frames(std::span<const PlacedFrame> frames, Blending blending,
                        const core::CameraModel& viewer,
                        const Eigen::Isometry3d& camera_from_object, const PixelRays& rays,
                        int threads) {
  const cv::Size size(viewer.width_px(), viewer.height_px());
  DrawnFrames drawn{cv::Mat(size, CV_32FC4, cv::Scalar::all(0)),
                    cv::Mat(size, CV_8UC1, cv::Scalar(0))};
  if (frames.empty()) return drawn;
  std::vector<ViewedFrame> viewed_frames;
  for (const PlacedFrame& frame : frames) {
    viewed_frames.push_back({frame, frame_in_view(frame.camera, viewer, camera_from_object)});
  }
  const Eigen::Vector3f centre =
      (camera_from_object * frames[0].camera.centre.cast<double>()).cast<float>();
  const float reach_squared = frames[0].camera.half_m * frames[0].camera.half_m;
  core::parallel_for(
      static_cast<std::size_t>(size.height), threads,
      [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
          const auto ray_x = rays.x(y);
          const auto ray_y = rays.y(y);
          for (int x = 0; x < size.width; ++x) {
            const Eigen::Vector3f ray(ray_x[static_cast<std::size_t>(x)],
                                      ray_y[static_cast<std::size_t>(x)], 1.0f);
            // No frame shows anything beside its sphere's outline.
            if (!(centre.cross(ray).squaredNorm() <= reach_squared * ray.squaredNorm())) continue;
            Eigen::Vector4f sum = Eigen::Vector4f::Zero();
            float shares = 0;
            float greatest = 0;
            bool supported = false;
            for (const ViewedFrame& frame : viewed_frames) {
              const Eigen::Vector3f in_frame = frame.view.frame_from_viewer * ray;
              const Meeting meeting = blending == Blending::nearest ? meet(frame, in_frame, 0.0f)
                                                                    : meet_surface(frame, in_frame);
              if (!(meeting.share > 0.0f)) continue;
              sum += meeting.share * frame.placed.image->read(meeting.place_px, frame.view.level);
              shares += meeting.share;
              if (meeting.share <= greatest) continue;
              greatest = meeting.share;
              supported = frame.placed.image->is_supported(meeting.place_px);
            }
            if (!(sum[3] > 0.0f)) continue;
            Eigen::Map<Eigen::Vector4f>(drawn.colour.ptr<float>(y) + std::ptrdiff_t{4} * x) =
                sum / shares;
            drawn.support.at<std::uint8_t>(y, x) = supported ? 255 : 0;
          }
        }
      },
      kRowsPerThread);
  return drawn;
}

}  // namespace sheen::render
