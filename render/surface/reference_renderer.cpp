// SPDX-License-Identifier: MIT
#include "core/concurrency/parallel_for.h"
#include "core/mesh/interpolation.h"
#include "core/samples/vertex_view.h"
#include "core/visibility/ray_caster.h"
#include "render/surface/surface_renderer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace sheen::render {
namespace {

constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

/// What one pixel sees.
struct PixelHit {
  std::uint32_t triangle_idx = kNoTriangle;
  Eigen::Vector3f barycentric = Eigen::Vector3f::Zero();
};

class ReferenceRenderer final : public Renderer {
 public:
  ReferenceRenderer(const core::Mesh& mesh, const fitting::PatchLightField& light_field,
                    int threads)
      : mesh_(mesh),
        light_field_(light_field),
        threads_(threads),
        caster_(mesh),
        frames_(core::tangent_frames(mesh)) {
    assert(light_field.patch_count() == mesh.positions.size());
  }

  /// Nothing to do: the light field is read at every image.
  std::size_t upload(std::span<const std::uint32_t> /*patches*/) override { return 0; }

  RenderedView render(const core::CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_object) override {
    cast_rays(camera, camera_from_object);
    eye_ = core::eye_in_object(camera_from_object);
    evaluate_vertices(eye_);
    return shade(camera.width_px(), camera.height_px());
  }

 private:
  void cast_rays(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object) {
    const Eigen::Vector3f eye = core::eye_in_object(camera_from_object);
    const Eigen::Matrix3d object_from_camera = camera_from_object.linear().transpose();
    const auto width = static_cast<std::size_t>(camera.width_px());
    hits_.assign(width * static_cast<std::size_t>(camera.height_px()), PixelHit{});
    core::parallel_for(hits_.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto ray =
            camera.unproject({static_cast<double>(i % width), static_cast<double>(i / width)});
        if (ray) hits_[i] = first_front(eye, (object_from_camera * *ray).cast<float>());
      }
    });
  }

  /// Passes through faces seen from behind, as back-face culling does.
  [[nodiscard]] PixelHit first_front(const Eigen::Vector3f& eye,
                                     const Eigen::Vector3f& direction) const {
    constexpr float step_over = 1.0f + 1e-5f;
    float near = 0;
    while (const auto hit =
               caster_.first_hit(eye, direction, near, std::numeric_limits<float>::infinity())) {
      if (hit->front_face) return {hit->triangle_idx, hit->barycentric};
      near = std::nextafter(hit->distance * step_over, std::numeric_limits<float>::infinity());
    }
    return {};
  }

  void evaluate_vertices(const Eigen::Vector3f& eye) {
    // Mark what the image needs.
    needed_.assign(mesh_.positions.size(), 0);
    for (const PixelHit& hit : hits_) {
      if (hit.triangle_idx == kNoTriangle) continue;
      for (const std::uint32_t vertex_idx : mesh_.triangles[hit.triangle_idx]) {
        needed_[vertex_idx] = 1;
      }
    }

    // Evaluate it.
    colours_.resize(mesh_.positions.size());
    core::parallel_for(colours_.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (needed_[i] == 0) continue;
        const auto direction = core::direction_towards(frames_[i], mesh_.positions[i], eye);
        colours_[i] = light_field_.interpolated_part(i, direction.uv);
      }
    });
  }

  [[nodiscard]] RenderedView shade(int width_px, int height_px) const {
    RenderedView view{cv::Mat(height_px, width_px, CV_8UC3), cv::Mat(height_px, width_px, CV_8UC1),
                      cv::Mat(height_px, width_px, CV_8UC1)};
    core::parallel_for(hits_.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const bool seen = hits_[i].triangle_idx != kNoTriangle;
        const fitting::WeightedColour sums = seen ? interpolate(hits_[i]) : kNothing;
        const Eigen::Vector3f colour = sums.colour() + (seen ? between(hits_[i]) : kBlack);
        const Eigen::Vector3f rgb = 255.0f * colour.cwiseMax(0.0f).cwiseMin(1.0f);
        for (int channel = 0; channel < 3; ++channel) {
          view.image.data[3 * i + static_cast<std::size_t>(channel)] =
              static_cast<std::uint8_t>(std::lround(rgb[2 - channel]));
        }
        view.mask.data[i] = seen ? 255 : 0;
        view.support.data[i] = sums.weight_sum > 2 * fitting::kUnseenWeight && seen ? 255 : 0;
      }
    });
    return view;
  }

  [[nodiscard]] fitting::WeightedColour interpolate(const PixelHit& hit) const {
    fitting::WeightedColour sums{Eigen::Vector3f::Zero(), 0.0f};
    for (int corner = 0; corner < 3; ++corner) {
      const fitting::WeightedColour& at_corner =
          colours_[mesh_.triangles[hit.triangle_idx][corner]];
      sums.colour_sum += hit.barycentric[corner] * at_corner.colour_sum;
      sums.weight_sum += hit.barycentric[corner] * at_corner.weight_sum;
    }
    return sums;
  }

  [[nodiscard]] Eigen::Vector3f between(const PixelHit& hit) const {
    const Eigen::Vector3f place = core::place_on(mesh_, hit.triangle_idx, hit.barycentric);
    return light_field_.between_patches(hit.triangle_idx, hit.barycentric,
                                        (eye_ - place).normalized());
  }

  inline static const Eigen::Vector3f kBlack = Eigen::Vector3f::Zero();
  /// Black, with a weight that can be divided by.
  inline static const fitting::WeightedColour kNothing{Eigen::Vector3f::Zero(), 1.0f};

  const core::Mesh& mesh_;
  const fitting::PatchLightField& light_field_;
  int threads_;
  core::RayCaster caster_;
  Eigen::Vector3f eye_ = Eigen::Vector3f::Zero();
  std::vector<core::TangentFrame> frames_;
  std::vector<PixelHit> hits_;
  std::vector<std::uint8_t> needed_;
  std::vector<fitting::WeightedColour> colours_;
};

}  // namespace

std::unique_ptr<Renderer> make_reference_surface_renderer(
    const core::Mesh& mesh, const fitting::PatchLightField& light_field, int threads) {
  return std::make_unique<ReferenceRenderer>(mesh, light_field, threads);
}

}  // namespace sheen::render
