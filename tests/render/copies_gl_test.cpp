// SPDX-License-Identifier: MIT
// Copies drawn at once with OpenGL against the reference on the CPU.
#include "fitting/descriptor.h"
#include "render/context/context.h"
#include "render/multi_eigenspace/copies_renderer.h"
#include "render/multi_eigenspace/eigenspace_renderer.h"
#include "tests/fitting/photographs_for_tests.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <vector>

namespace sheen::render {
namespace {

using fitting::multi_eigenspace::MultiEigenspace;
using fitting::testing::Photographs;

Eigen::Vector3f striped(const Eigen::Vector3f& point, const Eigen::Vector3f& towards_viewer) {
  return {0.5f + 0.3f * std::sin(80.0f * point.x()), 0.5f + 0.3f * std::sin(60.0f * point.y()),
          0.5f + 0.2f * towards_viewer.z()};
}

class Copies : public ::testing::Test {
 protected:
  Copies() : photographs_(testing::torus_knot(0.2f, 96, 12), 24, striped) {
    const auto fitter =
        fitting::make_fitter("multi-eigenspace", photographs_.mesh(), {{"picture-size", "64"}});
    std::vector<int> all(photographs_.views().size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    photographs_.show(all, *fitter);
    fitter->finish();
    model_ = std::make_unique<MultiEigenspace>(
        dynamic_cast<const MultiEigenspace&>(fitter->light_field()));
  }

  [[nodiscard]] RenderedView draw(const Eigen::Isometry3d& camera_from_scene,
                                  const std::vector<Eigen::Isometry3d>& places) const {
    return make_copies_renderer(*context_, *model_, places)->render(camera(), camera_from_scene);
  }
  [[nodiscard]] const core::CameraModel& camera() const { return photographs_.camera(); }

  Photographs photographs_;
  std::unique_ptr<Context> context_ = make_osmesa_context();
  std::unique_ptr<MultiEigenspace> model_;
};

// Shown larger than it is stored: the same four pixels are mixed. One grey level of rounding, but
// for a hundredth of the pixels: OSMesa places texels to 1/256.
TEST_F(Copies, OneIsTheReferencesImage) {
  const auto reference = make_eigenspace_renderer(*model_, 1);
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  for (const double azimuth : {0.1, 1.7, 4.0}) {
    const auto pose = testing::looking_at_origin({std::cos(azimuth), std::sin(azimuth), 0.5}, 0.36);
    const auto expected = reference->render(camera(), pose);
    const auto drawn = draw(pose, {here});
    EXPECT_GT(cv::countNonZero(expected.mask), 2000);
    EXPECT_LE(cv::countNonZero(expected.mask != drawn.mask), 10);
    const auto difference =
        testing::difference(drawn.image, expected.image, expected.mask & drawn.mask);
    EXPECT_LT(difference.mean, 0.5);
    EXPECT_LE(difference.quantile_999, 2.0);
  }
}

// Of two on one line of sight the nearer is seen, whichever is listed first; one behind the camera
// is not; and what a rigid motion moves with the camera looks the same.
TEST_F(Copies, NearerOnesHideOthers) {
  const auto pose = testing::looking_at_origin({1, 0, 0}, 0.36);
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d behind_it(Eigen::Translation3d(-0.3, 0, 0));
  const Eigen::Isometry3d behind_us(Eigen::Translation3d(0.8, 0, 0));
  const auto alone = draw(pose, {here});
  for (const auto& order :
       {std::vector{here, behind_it, behind_us}, {behind_it, behind_us, here}}) {
    const auto drawn = draw(pose, order);
    EXPECT_EQ(testing::difference(drawn.image, alone.image, alone.mask).largest, 0);
  }
  const Eigen::Isometry3d moved =
      Eigen::Translation3d(3, 1, -2) * Eigen::AngleAxisd(1, Eigen::Vector3d(0, 0.6, 0.8));
  const auto elsewhere = draw(pose * moved.inverse(), {moved});
  EXPECT_LT(testing::difference(elsewhere.image, alone.image, alone.mask).mean, 0.2);
}

TEST_F(Copies, NoneIsNothing) {
  const auto pose = testing::looking_at_origin({1, 0, 0}, 0.36);
  EXPECT_EQ(cv::countNonZero(draw(pose, {}).mask), 0);
}

}  // namespace
}  // namespace sheen::render
