// SPDX-License-Identifier: MIT
// The laws of photographs projected onto the mesh (docs/systems.md).
#include "fitting/view_dependent_texture/view_texture.h"

#include "fitting/descriptor.h"
#include "render/view_dependent_texture/view_texture_renderer.h"
#include "tests/fitting/photographs_for_tests.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sheen::fitting::view_dependent_texture {
namespace {

using render::testing::looking_at_origin;
using testing::Photographs;

/// A grey pattern and a highlight that turns with the viewer.
Eigen::Vector3f glossy_print(const Eigen::Vector3f& point, const Eigen::Vector3f& towards_viewer) {
  const Eigen::Vector3f wave = (100.0f * point).array().sin();
  const float shine = std::pow(
      std::max(0.0f,
               point.normalized().dot((towards_viewer + Eigen::Vector3f(0, 0, 1)).normalized())),
      20.0f);
  return Eigen::Vector3f::Constant(0.35f + 0.2f * wave.x() * wave.y() + 0.4f * shine);
}

std::vector<Eigen::Isometry3d> poses_at(const std::vector<double>& azimuths_deg) {
  std::vector<Eigen::Isometry3d> poses;
  for (const double azimuth : azimuths_deg) {
    const double angle = azimuth * M_PI / 180;
    poses.push_back(looking_at_origin({std::cos(angle), std::sin(angle), 0.7}, 0.36));
  }
  return poses;
}

Photographs photographs_from(core::Mesh mesh, const std::vector<double>& azimuths_deg) {
  return {std::move(mesh), poses_at(azimuths_deg), glossy_print};
}

ViewTexture fitted(const Photographs& photographs, const std::vector<int>& views,
                   OptionValues values = {}) {
  values["image-quality"] = "100";
  const auto fitter = make_fitter("view-dependent-texture", photographs.mesh(), values);
  photographs.show(views, *fitter);
  fitter->finish();
  return dynamic_cast<const ViewTexture&>(fitter->light_field());
}

/// Draws the first view; mean absolute difference from its photograph where it is supported.
double error_of_first(const Photographs& photographs, const ViewTexture& texture) {
  const auto& [truth, pose] = photographs.views().front();
  const auto renderer = render::make_view_texture_renderer(photographs.mesh(), texture, 1);
  const auto view = renderer->render(photographs.camera(), pose);
  return render::testing::difference(view.image, truth,
                                     render::testing::common_interior(view.support, view.mask, 3))
      .mean;
}

// The photograph of a view itself has angle 0 and the weight of a thousand others; what is left are
// rounding and the JPEG.
TEST(ViewTexture, PhotographsAreTheirOwnViews) {
  const auto photographs =
      photographs_from(render::testing::torus_knot(0.2f, 160, 20), {0, -15, 15, 40});
  EXPECT_LT(error_of_first(photographs, fitted(photographs, {0, 1, 2, 3})), 1.0);
}

TEST(ViewTexture, ErrorFallsWithNearerPhotographs) {
  const auto photographs =
      photographs_from(render::testing::torus_knot(0.2f, 160, 20), {0, -60, 60, -30, 30, -10, 10});
  const double far = error_of_first(photographs, fitted(photographs, {1, 2}));
  const double near = error_of_first(photographs, fitted(photographs, {1, 2, 3, 4}));
  const double nearest = error_of_first(photographs, fitted(photographs, {1, 2, 3, 4, 5, 6}));
  EXPECT_LT(near, 0.8 * far);
  EXPECT_LT(nearest, 0.8 * near);
}

// From behind nothing of what was photographed is seen: mean colours, marked as unsupported.
TEST(ViewTexture, MeanColoursStandInWhereNoneSees) {
  const auto photographs = photographs_from(render::testing::sphere(0.1f, 12), {180, 0, 10});
  const auto texture = fitted(photographs, {1, 2});
  const auto renderer = render::make_view_texture_renderer(photographs.mesh(), texture, 1);
  const auto view =
      renderer->render(photographs.camera(), photographs.views().front().camera_from_object);
  const int seen = cv::countNonZero(view.mask);
  EXPECT_GT(seen, 1000);
  // The poles of views 180 degrees apart, both from 35 degrees above, share a cap.
  EXPECT_LT(cv::countNonZero(view.support), seen / 2);
  cv::Mat dark;
  cv::inRange(view.image, cv::Scalar::all(0), cv::Scalar::all(10), dark);
  EXPECT_EQ(cv::countNonZero(dark & view.mask), 0);
}

// Whatever order photographs come in, and whatever the cache holds, the image is the same.
TEST(ViewTexture, OrderAndCacheDoNotShow) {
  const auto photographs =
      photographs_from(render::testing::torus_knot(0.2f, 160, 20), {0, -12, 15, 40, -33});
  const auto draw = [&](const std::vector<int>& order, const char* cache_mb) {
    const auto texture = fitted(photographs, order, {{"image-cache-mb", cache_mb}});
    const auto renderer = render::make_view_texture_renderer(photographs.mesh(), texture, 1);
    return renderer->render(photographs.camera(), photographs.views().front().camera_from_object)
        .image;
  };
  const cv::Mat image = draw({1, 2, 3, 4}, "256");
  EXPECT_EQ(cv::norm(image, draw({4, 2, 1, 3}, "256"), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(image, draw({1, 2, 3, 4}, "0"), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace sheen::fitting::view_dependent_texture
