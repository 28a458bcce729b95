// SPDX-License-Identifier: MIT
#include "render/views/ray_texture.h"

#include <opencv2/core/mat.hpp>

#include <cmath>
#include <limits>

namespace sheen::render {
namespace {

constexpr GLuint kRayUnit = 6;  ///< as in shaders/pixel_ray.glsl

}  // namespace

void RayTexture::set_camera(const core::CameraModel& camera) {
  if (texture_.name() != 0 && camera.intrinsics() == camera_.intrinsics()) return;
  const bool resized = texture_.name() == 0 || camera.width_px() != camera_.width_px() ||
                       camera.height_px() != camera_.height_px();
  camera_ = camera;
  rays_.set_camera(camera);
  if (resized) {
    texture_ = gl::make_texture(gl_, GL_TEXTURE_2D);
    gl_.TextureStorage2D(texture_.name(), 1, GL_RG32F, camera.width_px(), camera.height_px());
  }

  // Shaders need not know what is no number: a ray that is none goes far to the side.
  const auto or_none = [](float x) {
    return std::isnan(x) ? std::numeric_limits<float>::max() : x;
  };
  cv::Mat rays(camera.height_px(), camera.width_px(), CV_32FC2);
  for (int y = 0; y < rays.rows; ++y) {
    const auto ray_x = rays_.x(y);
    const auto ray_y = rays_.y(y);
    auto* const row = rays.ptr<cv::Vec2f>(y);
    for (std::size_t x = 0; x < ray_x.size(); ++x) row[x] = {or_none(ray_x[x]), or_none(ray_y[x])};
  }
  gl_.TextureSubImage2D(texture_.name(), 0, 0, 0, rays.cols, rays.rows, GL_RG, GL_FLOAT, rays.data);
}

void RayTexture::bind() const {
  gl_.BindTextureUnit(kRayUnit, texture_.name());
}

}  // namespace sheen::render
