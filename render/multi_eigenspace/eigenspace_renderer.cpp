// SPDX-License-Identifier: MIT
#include "render/multi_eigenspace/eigenspace_renderer.h"

#include "core/concurrency/parallel_for.h"
#include "core/samples/vertex_view.h"
#include "render/views/pixel_rays.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace sheen::render {
namespace {

using fitting::multi_eigenspace::Billboard;
using fitting::multi_eigenspace::billboard_towards;
using fitting::multi_eigenspace::MultiEigenspace;

/// Reads a picture (CV_32FC4) between its pixels; (0, 0) is the middle of the first one.
cv::Vec4f read_picture(const cv::Mat& picture, float x_px, float y_px) {
  const float x = std::clamp(x_px, 0.0f, static_cast<float>(picture.cols - 1));
  const float y = std::clamp(y_px, 0.0f, static_cast<float>(picture.rows - 1));
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const int right = std::min(left + 1, picture.cols - 1);
  const int bottom = std::min(top + 1, picture.rows - 1);
  const float u = x - static_cast<float>(left);
  const float v = y - static_cast<float>(top);
  const auto* const upper = picture.ptr<cv::Vec4f>(top);
  const auto* const lower = picture.ptr<cv::Vec4f>(bottom);
  return (upper[left] * (1 - u) + upper[right] * u) * (1 - v) +
         (lower[left] * (1 - u) + lower[right] * u) * v;
}

class EigenspaceRenderer final : public Renderer {
 public:
  EigenspaceRenderer(const MultiEigenspace& model, int threads)
      : model_(model), threads_(threads), rays_(threads) {}

  /// Nothing to do: the spaces are read when they are drawn.
  std::size_t upload(std::span<const std::uint32_t> /*spaces*/) override { return 0; }

  RenderedView render(const core::CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_object) override;

 private:
  const MultiEigenspace& model_;
  int threads_;
  PixelRays rays_;
};

/// The picture at about the resolution in which it is seen, so that nothing of it is left out.
cv::Mat as_seen(const cv::Mat& picture, const Billboard& board, double focal_px) {
  const double seen_px = 2 * board.half_side_m / board.distance_m * focal_px;
  const int side_px = std::max(1, static_cast<int>(std::ceil(seen_px)));
  if (side_px >= picture.cols) return picture;
  cv::Mat smaller;
  cv::resize(picture, smaller, {side_px, side_px}, 0, 0, cv::INTER_AREA);
  return smaller;
}

RenderedView EigenspaceRenderer::render(const core::CameraModel& camera,
                                        const Eigen::Isometry3d& camera_from_object) {
  const cv::Size size(camera.width_px(), camera.height_px());
  RenderedView drawn{
      cv::Mat(size, CV_8UC3, cv::Scalar::all(0)), cv::Mat(size, CV_8UC1, cv::Scalar(0)), {}};
  const auto board = billboard_towards(model_.frame(), camera_from_object.inverse().translation());
  const cv::Mat whole = board ? model_.picture(board->towards_eye) : cv::Mat();
  if (!whole.empty()) {
    const cv::Mat picture = as_seen(whole, *board, camera.intrinsics().focal_px.maxCoeff());
    rays_.set_camera(camera);
    // A ray r meets the plane at distance_m / -(towards_eye . r) along itself; there lies the
    // place right . r, down . r on it, in pixels of the picture.
    const Eigen::Matrix3d to_camera = camera_from_object.linear();
    const auto in_camera = [&](const Eigen::Vector3d& axis, double scale) -> Eigen::Vector3f {
      return (scale * (to_camera * axis)).cast<float>();
    };
    const double px_per_m = picture.cols / (2 * board->half_side_m);
    const Eigen::Vector3f right = in_camera(board->right, board->distance_m * px_per_m);
    const Eigen::Vector3f down = in_camera(board->down, board->distance_m * px_per_m);
    const Eigen::Vector3f away = in_camera(board->towards_eye, -1);
    const float middle = 0.5f * static_cast<float>(picture.cols);
    const auto draw_row = [&](int y) {
      const auto ray_x = rays_.x(y);
      const auto ray_y = rays_.y(y);
      for (int x = 0; x < size.width; ++x) {
        const Eigen::Vector3f ray(ray_x[static_cast<std::size_t>(x)],
                                  ray_y[static_cast<std::size_t>(x)], 1.0f);
        const float along = away.dot(ray);
        const float u = right.dot(ray) / along;
        const float v = down.dot(ray) / along;
        // Written so that a ray that is none sees nothing.
        if (!(along > 0.0f && std::abs(u) <= middle && std::abs(v) <= middle)) continue;
        const cv::Vec4f pixel = read_picture(picture, u + middle - 0.5f, v + middle - 0.5f);
        constexpr float half_covered = 127.5f;
        if (!(pixel[3] >= half_covered)) continue;
        for (int c = 0; c < 3; ++c) {
          drawn.image.at<cv::Vec3b>(y, x)[c] =
              static_cast<std::uint8_t>(std::lround(std::clamp(pixel[c], 0.0f, 255.0f)));
        }
        drawn.mask.at<std::uint8_t>(y, x) = 255;
      }
    };
    constexpr std::size_t rows = 16;
    core::parallel_for(
        static_cast<std::size_t>(size.height), threads_,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t y = begin; y < end; ++y) draw_row(static_cast<int>(y));
        },
        rows);
  }
  drawn.support = drawn.mask.clone();
  return drawn;
}

}  // namespace

std::unique_ptr<Renderer> make_eigenspace_renderer(const MultiEigenspace& model, int threads) {
  return std::make_unique<EigenspaceRenderer>(model, threads);
}

}  // namespace sheen::render
