// SPDX-License-Identifier: MIT
#include "render/view_dependent_texture/view_texture_renderer.h"

#include "core/concurrency/parallel_for.h"
#include "core/visibility/depth_image.h"
#include "core/visibility/ray_caster.h"
#include "render/views/crop_reader.h"
#include "render/views/pixel_rays.h"
#include "render/views/view_cache.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace sheen::render {
namespace {

using fitting::KeptView;
using fitting::view_dependent_texture::ViewTexture;

constexpr std::size_t kMegabyte = 1000000;
/// Photographs looked at for a pixel, beyond those that are blended: some do not see it.
constexpr std::size_t kSpare = 8;
/// Nearer angles count alike, radians.
constexpr float kLeastAngle = 1e-3f;
/// A photograph fades in over so many pixels from a jump of depth or its border.
constexpr float kFade_px = 4.0f;
/// Depths that differ by more than so many pixels' angle between neighbours are a jump; a surface
/// at a cosine of .2 changes by 5.
constexpr float kJumpPixels = 12.0f;

/// A photograph ready to be drawn.
struct DecodedView {
  cv::Mat pixels;
  cv::Mat depth_m;  ///< CV_32FC1 of the crop, 0 where the object is not
  cv::Mat fade;     ///< CV_32FC1 in [0, 1]

  [[nodiscard]] std::size_t byte_size() const {
    return pixels.total() * (pixels.elemSize() + 2 * sizeof(float));
  }
};

/// A photograph that may give a pixel its colour.
struct Candidate {
  float angle = std::numeric_limits<float>::infinity();
  std::uint32_t photograph_idx = 0;
  float fade = 0;  ///< 0 while it is not known to see the pixel's point
  Eigen::Vector3f bgr = Eigen::Vector3f::Zero();
};

/// Distance to what is no whole surface, as a weight.
cv::Mat fade_of(const cv::Mat& depth_m, float pixel_angle) {
  cv::Mat nearest, farthest;
  const cv::Mat around = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  cv::erode(depth_m, nearest, around);
  cv::dilate(depth_m, farthest, around);
  cv::Mat whole = (nearest > 0.0f) & (farthest - nearest <= kJumpPixels * pixel_angle * depth_m);
  // The border of the crop is one, too.
  cv::rectangle(whole, {0, 0}, {whole.cols - 1, whole.rows - 1}, cv::Scalar(0));
  cv::Mat fade;
  cv::distanceTransform(whole, fade, cv::DIST_L2, cv::DIST_MASK_3, CV_32F);
  return cv::min(fade / kFade_px, 1.0f);
}

class ViewTextureRenderer final : public Renderer {
 public:
  ViewTextureRenderer(const core::Mesh& mesh, const ViewTexture& texture, int threads)
      : mesh_(mesh),
        texture_(texture),
        threads_(threads),
        points_(core::surface_points(mesh)),
        caster_(mesh),
        depth_(mesh, threads),
        rays_(threads),
        cache_(static_cast<std::size_t>(texture.options().views.cache_mb) * kMegabyte) {}

  /// Nothing to do: photographs are only added, and read when they are drawn.
  std::size_t upload(std::span<const std::uint32_t> /*photographs*/) override { return 0; }

  RenderedView render(const core::CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_object) override;

 private:
  struct Pixel {
    int x, y;
    Eigen::Vector3f point;  ///< object frame, metres
  };

  void draw_depth(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object);
  const DecodedView& decoded(std::size_t photograph_idx);
  void find_points(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object);
  void find_candidates(const Eigen::Vector3f& eye);
  void read_photograph(std::size_t photograph_idx);
  [[nodiscard]] Eigen::Vector4f blend(std::size_t pixel_idx) const;
  [[nodiscard]] Eigen::Vector3f mean_colour(const Pixel& pixel, const Eigen::Vector3f& eye) const;

  const core::Mesh& mesh_;
  const ViewTexture& texture_;
  int threads_;
  core::SurfacePoints points_;
  core::RayCaster caster_;
  core::DepthImage depth_;
  core::VertexView view_;
  PixelRays rays_;
  ViewCache<DecodedView> cache_;
  std::vector<Pixel> pixels_;  ///< that see the mesh
  std::size_t per_pixel_ = 0;
  std::vector<Candidate> candidates_;  ///< [pixel][per_pixel_], by angle
};

void ViewTextureRenderer::draw_depth(const core::CameraModel& camera,
                                     const Eigen::Isometry3d& camera_from_object) {
  core::project_vertices(points_, camera, camera_from_object, {}, threads_, view_);
  depth_.draw(view_, {camera.width_px(), camera.height_px()}, camera_from_object);
}

const DecodedView& ViewTextureRenderer::decoded(std::size_t photograph_idx) {
  return cache_.get(photograph_idx, [&] {
    const KeptView& kept = texture_.photographs()[photograph_idx];
    draw_depth(kept.camera, kept.camera_from_object);
    cv::Mat depth_m(kept.crop.size(), CV_32FC1, cv::Scalar(0));
    const cv::Rect common = kept.crop & depth_.box();
    if (!common.empty()) {
      depth_.depth_m()(common - depth_.box().tl()).copyTo(depth_m(common - kept.crop.tl()));
    }
    const auto angle = 1.0f / static_cast<float>(kept.camera.intrinsics().focal_px.minCoeff());
    return DecodedView{kept.pixels(), depth_m, fade_of(depth_m, angle)};
  });
}

void ViewTextureRenderer::find_points(const core::CameraModel& camera,
                                      const Eigen::Isometry3d& camera_from_object) {
  draw_depth(camera, camera_from_object);
  const Eigen::Isometry3f object_from_camera = camera_from_object.inverse().cast<float>();
  pixels_.clear();
  const cv::Rect& box = depth_.box();
  for (int y = box.y; y < box.y + box.height; ++y) {
    const auto* const depth_m = depth_.depth_m().ptr<float>(y - box.y);
    const auto ray_x = rays_.x(y);
    const auto ray_y = rays_.y(y);
    for (int x = box.x; x < box.x + box.width; ++x) {
      const float depth = depth_m[x - box.x];
      const Eigen::Vector3f ray(ray_x[static_cast<std::size_t>(x)],
                                ray_y[static_cast<std::size_t>(x)], 1.0f);
      if (!(depth > 0.0f) || !ray.allFinite()) continue;
      pixels_.push_back({x, y, object_from_camera * (depth * ray)});
    }
  }
}

/// The nearest photographs by angle; equal ones in their order.
void ViewTextureRenderer::find_candidates(const Eigen::Vector3f& eye) {
  const std::size_t count = texture_.photographs().size();
  per_pixel_ = std::min(count, static_cast<std::size_t>(texture_.options().blended_views) + kSpare);
  std::vector<Eigen::Vector3f> eyes;
  for (const KeptView& view : texture_.photographs()) eyes.push_back(view.eye().cast<float>());
  candidates_.assign(pixels_.size() * per_pixel_, {});
  core::parallel_for(pixels_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f& point = pixels_[i].point;
      const Eigen::Vector3f to_eye = (eye - point).normalized();
      Candidate* const nearest = candidates_.data() + i * per_pixel_;
      for (std::size_t k = 0; k < count; ++k) {
        const Eigen::Vector3f to_photograph = eyes[k] - point;
        // The chord, which is the angle where that is small.
        const float cosine = to_photograph.dot(to_eye) / to_photograph.norm();
        const float angle = std::sqrt(std::max(0.0f, 2.0f - 2.0f * cosine));
        if (!(angle < nearest[per_pixel_ - 1].angle)) continue;
        std::size_t place = per_pixel_ - 1;
        for (; place > 0 && angle < nearest[place - 1].angle; --place) {
          nearest[place] = nearest[place - 1];
        }
        nearest[place].angle = angle;
        nearest[place].photograph_idx = static_cast<std::uint32_t>(k);
      }
    }
  });
}

/// Gives a photograph's colours to the pixels whose points it sees.
void ViewTextureRenderer::read_photograph(std::size_t photograph_idx) {
  const KeptView& kept = texture_.photographs()[photograph_idx];
  const DecodedView& view = decoded(photograph_idx);
  const float tolerance =
      kJumpPixels / static_cast<float>(kept.camera.intrinsics().focal_px.minCoeff());
  const auto look = [&](const Eigen::Vector3f& point, Candidate& candidate) {
    const Eigen::Vector3d in_camera = kept.camera_from_object * point.cast<double>();
    const auto pixel = kept.camera.project(in_camera);
    if (!pixel) return;
    const auto x = static_cast<float>(pixel->x() - kept.crop.x);
    const auto y = static_cast<float>(pixel->y() - kept.crop.y);
    if (!(x >= 0.0f && y >= 0.0f && x <= static_cast<float>(kept.crop.width - 1) &&
          y <= static_cast<float>(kept.crop.height - 1))) {
      return;
    }
    const auto column = static_cast<int>(std::lround(x));
    const auto row = static_cast<int>(std::lround(y));
    const float depth_m = view.depth_m.at<float>(row, column);
    if (!(static_cast<float>(in_camera.z()) <= depth_m * (1.0f + tolerance))) return;
    candidate.fade = view.fade.at<float>(row, column);
    candidate.bgr = read_between(view.pixels, x, y);
  };
  core::parallel_for(pixels_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < per_pixel_; ++k) {
        Candidate& candidate = candidates_[i * per_pixel_ + k];
        if (candidate.photograph_idx == photograph_idx) look(pixels_[i].point, candidate);
      }
    }
  });
}

/// Sum of weighted colours, and of the weights; 0 where no photograph sees the point.
Eigen::Vector4f ViewTextureRenderer::blend(std::size_t pixel_idx) const {
  const auto all = std::span(candidates_).subspan(pixel_idx * per_pixel_, per_pixel_);
  const auto most = static_cast<std::size_t>(texture_.options().blended_views);
  // Find the angle of the first one that is not blended.
  std::size_t seen = 0;
  float per_next = 0;
  for (const Candidate& one : all) {
    if (!(one.fade > 0.0f)) continue;
    if (seen++ < most) continue;
    per_next = 1.0f / std::max(one.angle, kLeastAngle);
    break;
  }
  // When that is as near as the others all count alike.
  constexpr float least = 1e-4f;
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  std::size_t blended = 0;
  for (const Candidate& one : all) {
    if (!(one.fade > 0.0f)) continue;
    if (blended++ == most) break;
    const float angle = std::max(one.angle, kLeastAngle);
    const float weight = one.fade * std::max(1.0f - angle * per_next, least) / angle;
    sum.head<3>() += weight * one.bgr;
    sum[3] += weight;
  }
  return sum;
}

Eigen::Vector3f ViewTextureRenderer::mean_colour(const Pixel& pixel,
                                                 const Eigen::Vector3f& eye) const {
  // Aimed at the point from a little before it.
  constexpr float before = 0.99f;
  const auto hit =
      caster_.first_hit(eye, pixel.point - eye, before, std::numeric_limits<float>::infinity());
  Eigen::Vector3f rgb = Eigen::Vector3f::Constant(0.5f);
  if (hit) {
    rgb.setZero();
    for (int corner = 0; corner < 3; ++corner) {
      rgb += hit->barycentric[corner] *
             texture_.means().mean_colour(mesh_.triangles[hit->triangle_idx][corner]);
    }
  }
  return 255.0f * Eigen::Vector3f(rgb.z(), rgb.y(), rgb.x());
}

RenderedView ViewTextureRenderer::render(const core::CameraModel& camera,
                                         const Eigen::Isometry3d& camera_from_object) {
  const cv::Size size(camera.width_px(), camera.height_px());
  const Eigen::Vector3f eye = core::eye_in_object(camera_from_object);
  rays_.set_camera(camera);
  find_points(camera, camera_from_object);
  find_candidates(eye);

  // One photograph after the other, so that any budget of the cache will do.
  std::vector<std::uint8_t> wanted(texture_.photographs().size(), 0);
  for (const Candidate& candidate : candidates_) wanted[candidate.photograph_idx] = 1;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] != 0 && !candidates_.empty()) read_photograph(i);
  }

  RenderedView drawn{cv::Mat(size, CV_8UC3, cv::Scalar::all(0)),
                     cv::Mat(size, CV_8UC1, cv::Scalar(0)), cv::Mat(size, CV_8UC1, cv::Scalar(0))};
  core::parallel_for(pixels_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Pixel& pixel = pixels_[i];
      const Eigen::Vector4f sum = blend(i);
      const bool seen = sum[3] > 0.0f;
      const Eigen::Vector3f bgr =
          seen ? Eigen::Vector3f(sum.head<3>() / sum[3]) : mean_colour(pixel, eye);
      for (int c = 0; c < 3; ++c) {
        drawn.image.at<cv::Vec3b>(pixel.y, pixel.x)[c] =
            static_cast<std::uint8_t>(std::lround(std::clamp(bgr[c], 0.0f, 255.0f)));
      }
      drawn.mask.at<std::uint8_t>(pixel.y, pixel.x) = 255;
      drawn.support.at<std::uint8_t>(pixel.y, pixel.x) = seen ? 255 : 0;
    }
  });
  return drawn;
}

}  // namespace

std::unique_ptr<Renderer> make_view_texture_renderer(const core::Mesh& mesh,
                                                     const ViewTexture& texture, int threads) {
  return std::make_unique<ViewTextureRenderer>(mesh, texture, threads);
}

}  // namespace sheen::render
