// SPDX-License-Identifier: MIT
#include "render/depth_quads/quad_renderer.h"

#include "core/concurrency/parallel_for.h"
#include "render/depth_quads/camera_choice.h"
#include "render/depth_quads/screen_quads.h"
#include "render/gl/functions.h"
#include "render/views/crop_reader.h"
#include "render/views/pixel_rays.h"
#include "render/views/view_cache.h"

#include <algorithm>
#include <cmath>

namespace sheen::render {
namespace {

using fitting::KeptView;
using fitting::depth_quads::Blending;
using fitting::depth_quads::DepthQuads;
using fitting::depth_quads::QuadView;

constexpr std::size_t kMegabyte = 1000000;
/// Fewer rows of an image are not worth a thread.
constexpr std::size_t kRows = 16;

/// A photograph ready to be drawn.
struct DecodedPhotograph {
  cv::Mat pixels;

  [[nodiscard]] std::size_t byte_size() const { return pixels.total() * pixels.elemSize(); }
};

/// Where a pixel's ray r meets a quad: its products with normal, to_a and to_b.
struct Meeting {
  float across, along_a, along_b;

  [[nodiscard]] float inverse_depth(const ScreenQuad& quad) const {
    return across * quad.per_volume;
  }
};

class QuadRenderer final : public Renderer {
 public:
  QuadRenderer(const DepthQuads& quads, int threads)
      : quads_(quads),
        threads_(threads),
        rays_(threads),
        cache_(static_cast<std::size_t>(quads.options().views.cache_mb) * kMegabyte) {}

  /// Nothing to do: photographs are only added, and read when they are drawn.
  std::size_t upload(std::span<const std::uint32_t> /*photographs*/) override { return 0; }

  RenderedView render(const core::CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_object) override;

 private:
  struct Sheet {
    std::size_t photograph_idx;
    float share;
    std::vector<ScreenQuad> quads;
  };

  const DecodedPhotograph& decoded(std::size_t photograph_idx);
  const RayGrid& rays_of(const core::CameraModel& camera);
  [[nodiscard]] std::vector<Sheet> sheets_for(const QuadCamera& viewer);
  /// Calls `visit(quad, x, y, met)` for all pixels that see a quad of the sheet.
  template <typename Visit>
  void for_each_pixel(const Sheet& sheet, int rows, const Visit& visit) const;
  void find_nearest(const Sheet& sheet);
  void paint_nearest(const Sheet& sheet, cv::Mat& image);
  void add_near(const Sheet& sheet, cv::Mat& sums);

  const DepthQuads& quads_;
  int threads_;
  PixelRays rays_;
  RayGrid photograph_rays_;  ///< of the camera that took the photograph looked at last
  ViewCache<DecodedPhotograph> cache_;
  cv::Mat inverse_depth_;  ///< CV_32FC1, of the nearest quad; 0 where there is none
};

const DecodedPhotograph& QuadRenderer::decoded(std::size_t photograph_idx) {
  return cache_.get(photograph_idx, [&] {
    return DecodedPhotograph{quads_.photographs()[photograph_idx].pixels()};
  });
}

/// Photographs of a recording share their camera.
const RayGrid& QuadRenderer::rays_of(const core::CameraModel& camera) {
  if (!(camera.intrinsics() == photograph_rays_.camera().intrinsics())) {
    photograph_rays_ = RayGrid(camera);
  }
  return photograph_rays_;
}

std::vector<QuadRenderer::Sheet> QuadRenderer::sheets_for(const QuadCamera& viewer) {
  std::vector<Sheet> sheets;
  for (const auto& [i, share] : choose_cameras(quads_, viewer.camera, viewer.camera_from_object)) {
    const KeptView& photograph = quads_.photographs()[i];
    const QuadView& quads = quads_.quads(i);
    const std::size_t level = choose_level(photograph, quads, viewer);
    const auto nodes = node_rays(photograph, quads.levels[level], rays_of(photograph.camera));
    sheets.push_back({i, share,
                      screen_quads(photograph, quads, level, nodes, quads_.options().enlargement,
                                   viewer, threads_)});
  }
  return sheets;
}

template <typename Visit>
void QuadRenderer::for_each_pixel(const Sheet& sheet, int rows, const Visit& visit) const {
  core::parallel_for(
      static_cast<std::size_t>(rows), threads_,
      [&](std::size_t begin, std::size_t end) {
        const int first = static_cast<int>(begin);
        const int last = static_cast<int>(end) - 1;
        for (const ScreenQuad& quad : sheet.quads) {
          for (int y = std::max(quad.top, first); y <= std::min(quad.bottom, last); ++y) {
            const auto ray_x = rays_.x(y);
            const auto ray_y = rays_.y(y);
            for (int x = quad.left; x <= quad.right; ++x) {
              const Eigen::Vector3f ray(ray_x[static_cast<std::size_t>(x)],
                                        ray_y[static_cast<std::size_t>(x)], 1.0f);
              const Meeting met{ray.dot(quad.normal), ray.dot(quad.to_a), ray.dot(quad.to_b)};
              // Written so that a ray that is none sees nothing.
              if (std::min(met.along_a, met.along_b) >= 0.0f &&
                  std::max(met.along_a, met.along_b) <= met.across) {
                visit(quad, x, y, met);
              }
            }
          }
        }
      },
      kRows);
}

Eigen::Vector3f colour_at(const DecodedPhotograph& photograph, const ScreenQuad& quad,
                          const Meeting& met) {
  const float scale = quad.side_px / met.across;
  return read_between(photograph.pixels, quad.first_x + scale * met.along_a,
                      quad.first_y + scale * met.along_b);
}

/// Of a colour within [0, 255].
std::uint8_t rounded(float grey) {
  return static_cast<std::uint8_t>(grey + 0.5f);
}

void QuadRenderer::find_nearest(const Sheet& sheet) {
  for_each_pixel(sheet, inverse_depth_.rows,
                 [&](const ScreenQuad& quad, int x, int y, const Meeting& met) {
                   if (quad.is_flier) return;
                   auto& nearest = inverse_depth_.at<float>(y, x);
                   nearest = std::max(nearest, met.inverse_depth(quad));
                 });
}

void QuadRenderer::paint_nearest(const Sheet& sheet, cv::Mat& image) {
  const DecodedPhotograph& photograph = decoded(sheet.photograph_idx);
  for_each_pixel(sheet, image.rows, [&](const ScreenQuad& quad, int x, int y, const Meeting& met) {
    auto& nearest = inverse_depth_.at<float>(y, x);
    if (met.inverse_depth(quad) <= nearest) return;
    nearest = met.inverse_depth(quad);
    const Eigen::Vector3f colour = colour_at(photograph, quad, met);
    auto& pixel = image.at<cv::Vec3b>(y, x);
    for (int c = 0; c < 3; ++c) pixel[c] = rounded(colour[c]);
  });
}

void QuadRenderer::add_near(const Sheet& sheet, cv::Mat& sums) {
  const DecodedPhotograph& photograph = decoded(sheet.photograph_idx);
  for_each_pixel(sheet, sums.rows, [&](const ScreenQuad& quad, int x, int y, const Meeting& met) {
    const float nearest = inverse_depth_.at<float>(y, x);
    if (met.inverse_depth(quad) * (1.0f + quad.tolerance) < nearest) return;
    const Eigen::Vector3f colour = colour_at(photograph, quad, met);
    auto& sum = sums.at<cv::Vec4f>(y, x);
    const float weight = sheet.share * quad.weight;
    for (int c = 0; c < 3; ++c) sum[c] += weight * colour[c];
    sum[3] += weight;
  });
}

/// Gives the mask of what has a colour.
cv::Mat divide(const cv::Mat& sums, cv::Mat& image) {
  cv::Mat mask(image.size(), CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto& sum = sums.at<cv::Vec4f>(y, x);
      if (!(sum[3] > 0.0f)) continue;
      for (int c = 0; c < 3; ++c) {
        image.at<cv::Vec3b>(y, x)[c] = rounded(sum[c] / sum[3]);
      }
      mask.at<std::uint8_t>(y, x) = 255;
    }
  }
  return mask;
}

RenderedView QuadRenderer::render(const core::CameraModel& camera,
                                  const Eigen::Isometry3d& camera_from_object) {
  const cv::Size size(camera.width_px(), camera.height_px());
  rays_.set_camera(camera);
  const std::vector<Sheet> sheets = sheets_for({camera, camera_from_object});
  cv::Mat image(size, CV_8UC3, cv::Scalar::all(0));
  cv::Mat mask;
  inverse_depth_.create(size, CV_32FC1);
  inverse_depth_.setTo(0);
  if (quads_.options().blending == Blending::hard) {
    for (const Sheet& sheet : sheets) paint_nearest(sheet, image);
    mask = inverse_depth_ > 0.0f;
  } else {
    for (const Sheet& sheet : sheets) find_nearest(sheet);
    cv::Mat sums(size, CV_32FC4, cv::Scalar::all(0));
    for (const Sheet& sheet : sheets) add_near(sheet, sums);
    mask = divide(sums, image);
  }
  return {image, mask, mask.clone()};
}

}  // namespace

std::unique_ptr<Renderer> make_quad_renderer(Context& context, const DepthQuads& quads,
                                             int threads) {
  return gl::is_software(gl::load_functions(context))
             ? make_cpu_quad_renderer(quads, threads)
             : make_gl_quad_renderer(context, quads, threads);
}

std::unique_ptr<Renderer> make_cpu_quad_renderer(const DepthQuads& quads, int threads) {
  return std::make_unique<QuadRenderer>(quads, threads);
}

}  // namespace sheen::render
