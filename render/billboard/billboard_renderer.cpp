// SPDX-License-Identifier: MIT
#include "render/billboard/billboard_renderer.h"

#include "core/samples/vertex_view.h"
#include "render/billboard/draw_frames.h"
#include "render/gl/functions.h"
#include "render/views/view_cache.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sheen::render {
namespace {

using fitting::billboard::Billboards;

constexpr std::size_t kBytesPerMb = 1000000;

/// Keeps a frame alive while it is drawn, even when the cache has let it go.
struct CachedFrame {
  std::shared_ptr<const FramePyramid> image;
  [[nodiscard]] std::size_t byte_size() const { return image->byte_size(); }
};

class BillboardRenderer final : public Renderer {
 public:
  BillboardRenderer(const Billboards& billboards, int threads)
      : billboards_(billboards),
        threads_(threads),
        rays_(threads),
        cache_(static_cast<std::size_t>(billboards.options().views.cache_mb) * kBytesPerMb) {}

  /// Frames that change are decoded again.
  std::size_t upload(std::span<const std::uint32_t> frames) override {
    if (!frames.empty()) cache_.clear();
    return 0;
  }

  RenderedView render(const core::CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_object) override;

 private:
  [[nodiscard]] std::vector<PlacedFrame> frames_for(const Eigen::Vector3f& eye);

  const Billboards& billboards_;
  int threads_;
  PixelRays rays_;
  ViewCache<CachedFrame> cache_;
};

std::vector<PlacedFrame> BillboardRenderer::frames_for(const Eigen::Vector3f& eye) {
  std::vector<PlacedFrame> frames;
  for (const auto& [i, share] : frames_towards(billboards_, eye)) {
    const std::size_t frame_idx = i;
    const auto make = [&] {
      return CachedFrame{std::make_shared<FramePyramid>(
          fitting::billboard::decode(billboards_.frame(frame_idx)), billboards_.options().side_px)};
    };
    frames.push_back({cache_.get(frame_idx, make).image, billboards_.camera(frame_idx), share});
  }
  return frames;
}

RenderedView BillboardRenderer::render(const core::CameraModel& camera,
                                       const Eigen::Isometry3d& camera_from_object) {
  rays_.set_camera(camera);
  const auto frames = frames_for(core::eye_in_object(camera_from_object));
  const DrawnFrames drawn = draw_frames(frames, billboards_.options().blending, camera,
                                        camera_from_object, rays_, threads_);
  const cv::Size size = drawn.colour.size();
  RenderedView view{cv::Mat(size, CV_8UC3, cv::Scalar::all(0)),
                    cv::Mat(size, CV_8UC1, cv::Scalar(0)), cv::Mat(size, CV_8UC1, cv::Scalar(0))};
  constexpr float half_covered = 0.5f;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto& colour = drawn.colour.at<cv::Vec4f>(y, x);
      if (!(colour[3] >= half_covered)) continue;
      for (int c = 0; c < 3; ++c) {
        view.image.at<cv::Vec3b>(y, x)[c] =
            static_cast<std::uint8_t>(std::lround(std::clamp(colour[c] / colour[3], 0.0f, 255.0f)));
      }
      view.mask.at<std::uint8_t>(y, x) = 255;
      view.support.at<std::uint8_t>(y, x) = drawn.support.at<std::uint8_t>(y, x);
    }
  }
  return view;
}

}  // namespace

std::unique_ptr<Renderer> make_billboard_renderer(Context& context, const Billboards& billboards,
                                                  int threads) {
  if (gl::is_software(gl::load_functions(context))) {
    return make_cpu_billboard_renderer(billboards, threads);
  }
  return make_gl_billboard_renderer(context, billboards, {Eigen::Isometry3d::Identity()}, threads);
}

std::unique_ptr<Renderer> make_cpu_billboard_renderer(const Billboards& billboards, int threads) {
  return std::make_unique<BillboardRenderer>(billboards, threads);
}

}  // namespace sheen::render
